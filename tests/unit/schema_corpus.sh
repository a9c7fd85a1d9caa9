#!/usr/bin/env bash
# The committed JSON Schemas are those of the program, and an independent validator with them comes to the same verdicts
# as our reader: on the corpus by hand, on the documents that ship, and on thousands made from the field table.
set -euo pipefail
build=$1 source=$2
same() { # FILE ARGUMENTS...
  local file=$source/schemas/$1
  shift
  "$build/clast" schema "$@" | cmp -s - "$file" && return
  echo "schema_corpus: $file is not what clast schema $* prints; if that is on purpose:"
  echo "  cmake --build --preset release --target schemas, and commit the file"
  exit 1
}
same scene-dem.schema.json scene --engine dem
same scene-sph.schema.json scene --engine sph
same campaign.schema.json campaign
exec /usr/bin/python3 "$source/tests/unit/schema_corpus.py" "$build/tests/test_schema_corpus" "$source"
