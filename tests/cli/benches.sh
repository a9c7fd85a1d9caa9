#!/usr/bin/env bash
# The short benchmarks run to their end, and they print only lines `name value unit`; the times themselves are not tested.
. "$(dirname "$0")/lib.bash"

figures() { # figures LEAST PROGRAM [ARGUMENT...]: the program prints at least LEAST figures
  local least=$1
  shift
  expect 0 "$@"
  ! grep -Ev '^[a-z0-9_]+ [+-]?[0-9.]+(e[+-]?[0-9]+)? [^ ]+$' out >err || fail "lines that are no figures (stderr)"
  [ "$(wc -l <out)" -ge "$least" ] || fail "$(wc -l <out) figures, expected $least at least"
}
figures 9 "$build/tests/bench/bench_palpha_program"
if [ -n "${CLAST_FULL:-}" ]; then
  figures 18 "$build/tests/bench/bench_dem_program"
  figures 20 "$build/tests/bench/bench_sph_program" 10000
else # half a minute, and other tests run the same code
  ok "(bench_dem not run)"; ok "(nor bench_sph)"
fi
done_after 3
