#!/usr/bin/env bash
# A small campaign and a run of each engine with memory refused, once per run, at one place of the program after the other
# (memory.py). Not under sanitizers: they bring their own allocator.
. "$(dirname "$0")/../cli/lib.bash"

if [ "$sanitized" -ne 0 ]; then
  echo "skipped: the sanitizers bring their own allocator"
  exit 77
fi
python "$source/tests/extremes/memory.py" "$build" "$build/tests/librefusing_allocator.so" || fail "places that end badly"
ok "memory refused at one place after the other"
done_after 1
