#!/usr/bin/env bash
# A campaign changed from the command line, the state of each campaign of a store, units as the user wrote them, and one name
# for each quantity.
. "$(dirname "$0")/lib.bash"

tiny tiny
expect 0 "$clast" plan tiny.yaml --set contact.friction=0.3 --seeds 5 --no-trial
prints "20, no store yet"
expect 0 "$clast" run tiny.yaml --set contact.friction=0.3 --set body.diameter='7 cm' --seeds 2 --quiet
same "$(sqlite3 tiny.db "select distinct path, value from point_input where path in ('contact.friction', 'body.diameter')" | xargs)" \
  "body.diameter|0.07 contact.friction|0.3" "inputs of --set in the store"
same "$(number tiny.db 'select count(*) from run')" 8 "runs of --seeds 2"
# the store's document is the changed one: a run from it finds all runs in the store
sqlite3 tiny.db "select document from campaign" >again.yaml
expect 0 "$clast" run again.yaml
says "0 runs computed"; says "8 found"
expect 64 "$clast" run tiny.yaml --set contact.frction=0.3
says "command line: error: set.contact.frction"; says "contact.friction"
expect 0 "$clast" plan tiny.yaml --no-trial --set threshold.strain='3 %' # the later layer wins
prints "grid, 2 points"
expect 64 "$clast" run tiny.yaml --set body.diameter=-1
expect 64 "$clast" run tiny.yaml --set nonsense
expect 64 "$clast" run tiny.yaml --seeds -1
tiny until 'quantity: largest_fraction'
sed -i 's/seeds: .*/seeds: {until: {half_width: 0.5}}/' until.yaml
sed -i 's/0.5}}/0.5}, max: 50}/' until.yaml
expect 0 "$clast" run until.yaml --seeds 4 --quiet # in the place of the rule
same "$(number until.db "select count(distinct seed), count(*) from run")" "4,16" "runs without the rule"

# the closing table: the units of the campaign, no wider than a terminal; programs get SI
expect 0 "$clast" estimates tiny.db
grep -qE "^strain \[%\] +angle +point" out || fail "varied inputs come first, in the order of the campaign"
same "$(awk '$3 == 1 && $1 ~ /^[0-9]/ {print $1, $2}' out)" "2 2" "varied inputs in per cent and degrees"
same "$(python -c "print(max(len(l.rstrip('\n')) for l in open('out')) <= 100)")" True "closing table in 100 columns"
expect 0 "$clast" stats tiny.db --by angle
prints "angle [deg]"
expect 0 "$clast" estimates tiny.db --csv
grep -q '^1,0.0349' out || fail "CSV is not in radians"
cat >wide.yaml <<'YAML'
name: wide
scene: disc-explosion
set: {stop.end_time: 1 ms}
vary: {threshold.strain: [2 %], threshold.angle: [2 deg], contact.friction: [0.1], body.diameter: [8 cm], charge.energy: [2000 J/m]}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run wide.yaml --quiet
prints "ML"
same "$(python -c "print(max(len(l.rstrip('\n')) for l in open('out')) <= 100)")" True "table of five inputs in 100 columns"

# each campaign has its own state, also when a merge brings a session that was killed
state() { "$toy" status "$1" --json | python -c "import json, sys; print(*[r['name'] + '=' + r['state'] for r in json.load(sys.stdin)])"; }
cp wide.db killed.db
sqlite3 killed.db "update session set ended_at = null, outcome = null; delete from run where replicate = 1"
same "$(state killed.db)" "wide=killed" "a session without an end"
"$clast" merge all.db tiny.db killed.db >/dev/null 2>&1 || fail "merge"
same "$(state all.db)" "tiny=finished tiny=finished wide=killed" "states after a merge"
"$clast" merge all.db wide.db >/dev/null 2>&1 || fail "merge again"
same "$(state all.db)" "tiny=finished tiny=finished wide=finished" "states when the missing runs came"
waiting slow
for clock in right "set back"; do
  "$toy" run slow.yaml -j 1 --quiet >/dev/null 2>&1 &
  for _ in $(seq 100); do sleep 0.05; [ "$(state slow.db 2>/dev/null)" = slow=running ] && break; done
  same "$(state slow.db)" "slow=running" "state while it runs, clock $clock"
  kill -TERM $! # a shell script starts background jobs with SIGINT ignored
  wait $! || true
  same "$(state slow.db)" "slow=stopped" "state after an interrupt, clock $clock"
  # as if the clock was fast then and is set back now
  sqlite3 slow.db "update session set started_at = '2099-01-01T00:00:00.000Z', ended_at = '2099-01-01T00:00:09.000Z', outcome = 'failed'"
done

# A process that hangs holds the store: the last sign of life is told.
same "$(sqlite3 slow.db "update session set started_at = '2020-01-01T00:00:00.000Z'; update run set finished_at = unixepoch('now') - 720; select changes() > 0")" 1 "old runs"
python - "$clast" <<'PY'
import fcntl, struct, subprocess, sys
F_OFD_SETLK, LOCK_BYTE = 37, 1 << 62 # db/store/store.c
with open("slow.db", "r+b") as held:
    fcntl.fcntl(held, F_OFD_SETLK, struct.pack("hhqqi4x", fcntl.F_WRLCK, 0, LOCK_BYTE, 1, 0))
    open("err", "w").write(subprocess.run([sys.argv[1], "status", "slow.db"], capture_output=True, text=True).stderr)
PY
says "no sign of life for 12 min"
# A writer that ends in a moment, such as the ranks of an mpirun that was killed, is waited for.
cp tiny.db held.db
python - "$clast" <<'PY'
import fcntl, struct, subprocess, sys, time
with open("held.db", "r+b") as held:
    fcntl.fcntl(held, 37, struct.pack("hhqqi4x", fcntl.F_WRLCK, 0, 1 << 62, 1, 0))
    merge = subprocess.Popen([sys.argv[1], "merge", "held.db", "killed.db"])
    time.sleep(1)
    assert merge.poll() is None, "it does not wait"
assert merge.wait() == 0
PY
ok "a writer that ends is waited for"

# one name for each quantity, and only columns of the engine
columns=$(sqlite3 tiny.db "select count(*) from pragma_table_info('runs')")
[ "$columns" -lt 80 ] || fail "the view runs has $columns columns"
same "$(sqlite3 tiny.db "select count(*) from pragma_table_info('runs') where name in ('crater_depth', 'result_dem_energy_kinetic')")" 0 "columns of the other engine"
for name in energy.kinetic energy_kinetic result_dem_energy_kinetic; do
  expect 0 "$clast" stats tiny.db --quantity $name --csv
  grep -q ',energy_kinetic_mean,' out || fail "$name is not energy_kinetic"
done
# explain answers for each word that a user meets: keys, columns of the views, words of messages and tables
# (under sanitizers every tenth of the columns: one piece of code looks all of them up)
for word in campaign results outcome sph dem vary keep seeds set design limits censored counted surplus interval window ML \
  beta_masses_from_5 result_dem_energy_kinetic largest_fraction_mean \
  $(sqlite3 tiny.db "select name from (select name, row_number() over (order by name) as n from
      (select name from pragma_table_info('runs') union select name from pragma_table_info('points')))
    where $sanitized = 0 or n % 10 = 0"); do
  "$clast" explain "$word" >out 2>err && [ -s out ] || fail "explain does not know $word"
done
ok "explain knows every word"
expect 65 "$clast" explain windw
says "did you mean window"
sed -i 's|seeds: .*|seeds: {until: {quantity: energy_kinetic, half_width: 1e9 J/m}}|' tiny.yaml
expect 0 "$clast" plan tiny.yaml --no-trial
done_after 35
