#!/usr/bin/env bash
# The mutator of tests/mutants finds the mutants of a toy, and what the toy's test makes of them.
set -euo pipefail
/usr/bin/python3 "$2/tests/mutants/self_test.py"
