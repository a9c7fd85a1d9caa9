# Common parts of the command-line tests. Each script is `bash NAME.sh BUILD_FOLDER SOURCE_FOLDER`, works in a folder of its own
# under the build folder, prints a line per thing it checks, and asserts at its end how many checks it made (`done_after`),
# so that a script that skipped half of them cannot pass.
set -euo pipefail
build=$1 source=$2
clast=$build/clast
toy=$build/tests/clast_toy # clast with an engine without physics (tests/support/toy_engine.h)
work=$(mktemp -d "$build/cli-$(basename "$0" .sh)-XXXXXX")
# Only the script itself clears up: what it starts with & is a copy of it for a moment, and a signal that comes before the
# copy has become the command runs this trap there.
trap '[ "$BASHPID" != $$ ] || rm -rf "$work"' EXIT
cd "$work"
export NO_COLOR=1 TERM=dumb
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
unset CDPATH
mkdir bin
PATH=$work/bin:$PATH
# Both names are Debian's python, which has the packages of the tests; another one may come first in PATH.
ln -s /usr/bin/python3 bin/python
ln -s /usr/bin/python3 bin/python3
sanitized=$("$clast" version | grep -c fsanitize || true)
if [ "$sanitized" -ne 0 ]; then # Open MPI itself leaks; without it, leaks are checked
  export LSAN_OPTIONS="suppressions=$source/tests/leaks.supp:print_suppressions=0"
  printf '#!/bin/sh\nASAN_OPTIONS=detect_leaks=0 exec %s "$@"\n' "$(command -v mpirun)" >bin/mpirun
  chmod +x bin/mpirun
fi
checks=0
command_limit=480 # s, for one command

fail() {
  echo "FAILED: $*"
  [ -f out ] && { echo "--- stdout"; head -c 2000 out; }
  [ -f err ] && { echo "--- stderr"; head -c 4000 err; }
  exit 1
}
ok() { checks=$((checks + 1)); echo "ok $checks: $*"; }

# expect CODE COMMAND...: runs it (stdout to ./out, stderr to ./err) and compares its exit code. Its standard input is empty,
# but that of `python -` is the script.
expect() {
  local want=$1 got=0 input=/dev/null
  shift
  [ "${1-} ${2-}" != "python -" ] || input=/dev/stdin
  timeout "$command_limit" "$@" >out 2>err <"$input" || got=$?
  [ "$got" -eq "$want" ] || fail "exit $got, expected $want: $*"
  # Our lines have 100 columns at most; a command in `...` is a word, and a word, such as a path, may be longer.
  [ "${1-}" != "$clast" ] || awk '
    /^  / || length($0) <= 100 { next }
    { gsub(/±|≥/, "+"); sub(/^.*error: /, ""); gsub(/`[^`]*`/, "command"); if (length($0) > 100 && NF > 1) exit 1 }' err || fail "wide lines"
  ok "exit $want: $(echo "$*" | sed "s|$build/||; s|$work/||g" | cut -c1-100)"
}
says() { tr '\n' ' ' <err | grep -qF -- "$1" || fail "stderr does not say: $1"; } # on stderr, whose lines end at column 100
prints() { grep -qF -- "$1" out || fail "stdout does not have: $1"; }    # on stdout
silent() { [ ! -s "$1" ] || fail "$1 should be empty"; }
# Exactly one error line in our form.
one_error() { [ "$(grep -c 'error: ' err)" -eq 1 ] || fail "expected one error line"; }
same() { [ "$1" = "$2" ] || fail "${3:-values}: \"$1\" is not \"$2\""; ok "${3:-same}: $1"; }
done_after() { [ "$checks" -eq "$1" ] || fail "made $checks checks, expected $1"; echo "$checks checks"; }

# A campaign of 4 points and 3 seeds that takes a fraction of a second. tiny NAME [LINE...]: writes NAME.yaml.
tiny() {
  local name=$1
  shift
  cat >"$name.yaml" <<YAML
name: $name
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
vary:
  threshold.strain: [2 %, 5 %]
  threshold.angle: [2 deg, 6 deg]
seeds: {per_point: 3}
store: $name.db
YAML
  local line
  for line in "$@"; do echo "$line" >>"$name.yaml"; done
}
# Campaigns of two scenes, which share body.diameter alone, and their runs in one store: two_scenes STORE.
two_scenes() {
  tiny burst && tiny crash
  sed -i 's/^set: .*/set: {stop.end_time: 1 ms}/; s/threshold.strain: .*/charge.energy: [1 kJ\/m, 2 kJ\/m]/; s/threshold.angle: .*/body.diameter: [7 cm, 8 cm]/' burst.yaml
  sed -i 's/disc-explosion/disc-collision/; s/^set: .*/set: {body.diameter: 8 cm, stop.end_time: 1 ms}/; s/threshold.strain: .*/collision.speed: [40 m\/s, 90 m\/s]/; /threshold.angle/d' crash.yaml
  expect 0 "$clast" run burst.yaml --quiet
  expect 0 "$clast" run crash.yaml --quiet
  expect 0 "$clast" merge "$1" burst.db crash.db
}
number() { "$clast" query "$1" "$2" --csv | tail -n 1; } # number STORE SQL
# The deterministic content of a store: the same for any way of computing it.
bits() { "$clast" export "$1" "$1.bits" --bits 2>>err || fail "no bits of $1"; [ -s "$1.bits" ] || fail "empty bits"; cat "$1.bits"; }
same_bits() { # same_bits STORE REFERENCE.bits WHAT
  bits "$1" | cmp -s - "$2" || fail "$3: the store differs from the reference"
  "$clast" check "$1" >out 2>err || fail "$3: the store does not pass clast check"
  ok "$3: same bits as the reference"
}

# The same for tests of campaigns and stores alone: its runs, of engine toy, wait 20 ms each instead of computing. It takes
# some 3 s with two slots, and is run by $toy. waiting NAME: writes NAME.yaml.
waiting() {
  slow_seeds=100
  printf 'engine: toy\nwait: 20 ms\n' >stick.yaml
  cat >"$1.yaml" <<YAML
name: $1
scene: stick.yaml
vary: {stick.strain: [2 %, 3 %, 5 %]}
seeds: {per_point: $slow_seeds}
store: $1.db
YAML
}
# A campaign to be interrupted: 3 points, and so many seeds (slow_seeds) that it takes some 3 s on one core of this machine in
# this build, whatever its speed. A few runs are timed first: by the processor time in the store, the least of them, as the
# start of a program and other tests beside this one are no part of a run.
slow() {
  local least
  cat >timed.yaml <<YAML
name: timed
scene: disc-explosion
set: {body.diameter: 14 cm, charge.energy: 6 kJ/m, stop.end_time: 1.5 ms}
seeds: {per_point: 4}
store: timed.db
YAML
  "$clast" run timed.yaml -j 1 --quiet >/dev/null 2>&1 || fail "a few runs of the slow campaign"
  least=$(number timed.db 'select max(1, cast(1e6 * min(cpu_time) as integer)) from run') # microseconds
  rm timed.*
  slow_seeds=$((3000000 / (3 * least) + 4))
  [ "$slow_seeds" -le 300 ] || slow_seeds=300
  cat >"$1.yaml" <<YAML
name: slow
scene: disc-explosion
set: {body.diameter: 14 cm, charge.energy: 6 kJ/m, stop.end_time: 1.5 ms}
vary: {threshold.strain: [2 %, 3 %, 5 %]}
seeds: {per_point: $slow_seeds}
store: $1.db
YAML
}
