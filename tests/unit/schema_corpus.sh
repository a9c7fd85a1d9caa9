#!/usr/bin/env bash
# An independent validator with the JSON Schemas of the program comes to the same verdicts as our reader: on the corpus by
# hand, on the documents that ship, and on thousands made from the field table.
set -euo pipefail
build=$1 source=$2
exec /usr/bin/python3 "$source/tests/unit/schema_corpus.py" "$build/tests/test_schema_corpus" "$source" "$build/clast"
