#!/usr/bin/env bash
# Signals: the first ends a campaign cleanly with 75 and the same command finishes it; kill -9 of any of its processes, and
# of mpirun, at random instants loses nothing that was committed. Each time the finished store has the reference's bits.
. "$(dirname "$0")/../cli/lib.bash"

clast=$toy
waiting slow
rounds=$([ -n "${CLAST_FULL:-}" ] && echo 10 || echo 1)
expect 0 "$clast" run slow.yaml -j 2 --quiet
bits slow.db >reference.bits
same "$(number slow.db 'select count(*) from run')" $((3 * slow_seeds)) "runs of the reference"

# start STORE COMMAND...: in the background, with the signals a terminal would give, until the store has its first runs,
# which it commits after a second.
start() {
  local store=$1
  shift
  setsid env --default-signal=INT,TERM,USR1 "$@" --store "$store" >out 2>err &
  pid=$!
  local i
  for i in $(seq 300); do
    if [ "$("$clast" query "$store" 'select count(*) from run' --csv 2>/dev/null | tail -n 1)" -ge 1 ] 2>/dev/null; then return; fi
    sleep 0.05
  done
  fail "no run after 15 s"
}
# ends in CODE...: one of the codes
ends() {
  local got=0 code
  wait "$pid" || got=$?
  for code in "$@"; do [ "$got" -eq "$code" ] && { ok "ended with $got"; return; }; done
  fail "exit $got, expected $*"
}
descendants() { local p; for p in $(pgrep -P "$1"); do echo "$p"; descendants "$p"; done; }
# No process of the campaign may be left shortly after its end. The process group of setsid is its pid.
gone() {
  local i
  for i in $(seq 100); do pgrep -s "$pid" >/dev/null || { ok "no process is left"; return; }; sleep 0.1; done
  fail "left behind: $(pgrep -as "$pid")"
}
finish() { # finish STORE WHAT
  expect 0 "$clast" run slow.yaml -j 2 --store "$1"
  grep -qE "[1-9][0-9]* found in the store" err || fail "nothing was found in the store"
  same_bits "$1" reference.bits "$2"
}

signals=(INT USR1)
[ -n "${CLAST_FULL:-}" ] && signals+=(TERM)
for signal in "${signals[@]}"; do
  start "$signal.db" "$clast" run slow.yaml -j 2
  kill "-$signal" "$pid"
  ends 75; says "the same command goes on"; gone
  finish "$signal.db" "after SIG$signal"
done

start twice.db "$clast" run slow.yaml -j 2
kill -INT "$pid"; sleep 0.02; kill -INT "$pid" 2>/dev/null || true
ends 75 130; gone
finish twice.db "after two signals"

for i in $(seq "$rounds"); do
  start manager.db "$clast" run slow.yaml -j 2
  sleep "0.$((RANDOM % 10))"; kill -9 "$pid"
  ends 137; gone
  finish manager.db "after kill -9 of the manager"; rm manager.db*

  start slot.db "$clast" run slow.yaml -j 2
  victims=($(descendants "$pid"))
  [ "${#victims[@]}" -ge 2 ] || fail "no child processes"
  kill -9 "${victims[RANDOM % ${#victims[@]}]}" 2>/dev/null || true
  ends 0 1 70 74 75; gone
  finish slot.db "after kill -9 of one of its processes"; rm slot.db*

  start mpirun.db mpirun -n 3 --oversubscribe --bind-to none "$clast" run slow.yaml
  sleep "0.$((RANDOM % 10))"; kill -9 "$pid"
  ends 137; gone
  finish mpirun.db "after kill -9 of mpirun"; rm mpirun.db*

  start rank.db mpirun -n 3 --oversubscribe --bind-to none "$clast" run slow.yaml
  victims=($(descendants "$pid"))
  kill -9 "${victims[RANDOM % ${#victims[@]}]}" 2>/dev/null || true
  got=0; wait "$pid" || got=$?
  ok "mpirun ended with $got after kill -9 of a process below it"; gone
  finish rank.db "after kill -9 of a process below mpirun"; rm rank.db*
done

start term.db mpirun -n 3 --oversubscribe --bind-to none "$clast" run slow.yaml
kill -TERM "$pid"
got=0; wait "$pid" || got=$?
[ "$got" -ne 0 ] || fail "mpirun says 0 after SIGTERM"
gone
finish term.db "after SIGTERM to mpirun"
done_after $((2 + 4 * (${#signals[@]} + 1) + 16 * rounds + 3))
