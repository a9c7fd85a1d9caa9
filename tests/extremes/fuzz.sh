#!/usr/bin/env bash
# The fuzz targets by libFuzzer with sanitizers, a minute each, in a build of its own (CLAST_FULL=1). Their short form is
# unit.fuzz_NAME_replay: variations of the seed corpus.
set -euo pipefail
source=$2
[ "${CLAST_FULL:-}" = 1 ] || exit 77
names=($(ls "$source/tests/fuzz/corpus"))
command -v clang >/dev/null || { echo "fuzz: needs clang"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake -S "$source" -B "$work/build" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG="-g -O1" -DCMAKE_C_COMPILER=clang \
  -DCLAST_FUZZ=ON -DCLAST_SANITIZE=address,undefined >"$work/log" || { cat "$work/log"; exit 1; }
cmake --build "$work/build" --target "${names[@]/#/fuzz_}" -j2 >"$work/log" || { tail -50 "$work/log"; exit 1; }
cd "$work"
for name in "${names[@]}"; do
  mkdir "$name"
  LSAN_OPTIONS=print_suppressions=0 "$work/build/tests/fuzz/fuzz_$name" -max_total_time=60 -max_len=2000 -timeout=10 \
    "$name" "$source/tests/fuzz/corpus/$name" >"$name.log" 2>&1 || {
    tail -40 "$name.log"
    cp crash-* leak-* timeout-* oom-* "$source/tests/fuzz/corpus/$name/" 2>/dev/null || true
    echo "fuzz: fuzz_$name found something; its input is now in tests/fuzz/corpus/$name"
    exit 1
  }
  tail -1 "$name.log"
done
