#!/usr/bin/env bash
# The committed JSON Schemas are those of the program, and an independent validator with them comes to the same verdicts
# as our reader: on the corpus by hand, on the documents that ship, and on thousands made from the field table.
set -euo pipefail
build=$1 source=$2
program=$build/tests/test_schema_corpus
for kind in scene-dem scene-sph campaign; do
  file=$source/schemas/$kind.schema.json
  if ! "$program" schema $kind | cmp -s - "$file"; then
    echo "schema_corpus: $file is not what the program writes; if the tables changed on purpose: $program schema $kind > $file"
    exit 1
  fi
done
exec /usr/bin/python3 "$source/tests/unit/schema_corpus.py" "$program" "$source"
