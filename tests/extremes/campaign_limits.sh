#!/usr/bin/env bash
# Campaigns that meet their limits: time, memory, failing inputs, a store that cannot be written. Each ends in a clear
# message and the documented exit code, keeps what it has, and goes on when the cause is gone.
. "$(dirname "$0")/../cli/lib.bash"
ask() { python -c "import sqlite3, sys; print(sqlite3.connect('file:%s?mode=ro' % sys.argv[1], uri=True).execute(sys.argv[2]).fetchone()[0])" "$1" "$2"; }

# Runs of many seconds against a limit of a fraction of one: ended, tried again, given up; a raised limit tries again.
tiny slow "limits: {time: 0.3 s, attempts: 2}"
sed -i 's/body.diameter: 8 cm/body.diameter: 60 cm/; s/per_point: 3/per_point: 1/; s/\[2 %, 5 %\]/[2 %]/' slow.yaml
sed -i 's/stop.end_time: 1 ms/stop.end_time: 200 ms, stop.quiet_time: 200 ms/' slow.yaml
expect 1 "$clast" run slow.yaml -j 2
says "2 runs failed"
same "$(ask slow.db "select count(*) || ' ' || group_concat(distinct reason) from attempt")" "4 time_limit" "attempts"
expect 1 "$clast" run slow.yaml -j 2 # given up: nothing is tried again
same "$(ask slow.db "select count(*) from attempt")" 4 "attempts after the same command"
sed -i 's/limits: {time: 0.3 s/limits: {time: 120 s/; s/60 cm/8 cm/; s/: 200 ms/: 1 ms/g' slow.yaml # (smaller as well, so that this test is quick)
expect 0 "$clast" run slow.yaml -j 2

# A raised limit alone: the same runs, which the shorter limit had ended.
tiny raised "limits: {time: 10 ms, attempts: 1}"
sed -i 's/body.diameter: 8 cm/body.diameter: 30 cm/; s/per_point: 3/per_point: 1/' raised.yaml
expect 1 "$clast" run raised.yaml -j 2
same "$(ask raised.db "select count(*) from run")" 0 "runs within ten milliseconds"
sed -i 's/time: 10 ms/time: 2 min/' raised.yaml
expect 0 "$clast" run raised.yaml -j 2
says "4 runs computed"

# Inputs that cannot be run together: twenty failures among the first fifty end it; they are results, so no attempt is wasted.
tiny unstable
sed -i 's/per_point: 3/per_point: 20/; s/set: {/set: {fidelity.time_step: 100 us, /' unstable.yaml
expect 1 "$clast" run unstable.yaml -j 2
says "stopped: 20 of the first"
same "$(ask unstable.db "select count(*) >= 20 and count(*) < 50 and min(state) = 'invalid' from run")" 1 "failed results are kept"
grep -q "unstable above" <<<"$(ask unstable.db 'select message from run')" || fail "the result does not say why"
echo "limits: {failures: 0}" >>unstable.yaml
expect 1 "$clast" run unstable.yaml -j 2
same "$(ask unstable.db "select count(*) from run")" 80 "with failures: 0 it goes on"

# Memory: an attempt over its limit costs that run only.
tiny fat "limits: {memory: 1 MiB, attempts: 1, failures: 0}"
sed -i 's/body.diameter: 8 cm/body.diameter: 60 cm/; s/per_point: 3/per_point: 1/; s/stop.end_time: 1 ms/stop.end_time: 0.01 ms/' fat.yaml
if [ "$sanitized" -eq 0 ]; then
  expect 1 "$clast" run fat.yaml -j 2
  same "$(ask fat.db "select count(*) || ' ' || group_concat(distinct reason) from attempt")" "4 memory_limit" "attempts"
  sed -i 's/memory: 1 MiB/memory: 1 GiB/' fat.yaml
  expect 0 "$clast" run fat.yaml -j 2
  says "4 runs computed"
else # the sanitizers themselves need terabytes of address space
  ok "(memory limit not tried)"; ok "(its reason neither)"; ok "(nor a raised one)"
fi

# The store: held by another, foreign, in no folder.
tiny held
sed -i 's/per_point: 3/per_point: 20000/' held.yaml
"$clast" run held.yaml -j 1 -q >/dev/null 2>&1 &
holder=$!
for _ in $(seq 100); do [ "$(ask held.db 'select count(*) from run' 2>/dev/null || echo 0)" -gt 0 ] && break; sleep 0.1; done
expect 74 "$clast" run held.yaml -j 1
says "$holder"
expect 74 mpirun -n 2 --oversubscribe "$clast" run held.yaml
kill -TERM $holder
got=0; wait $holder || got=$?
same "$got" 75 "the holder stops cleanly"
tiny foreign
head -c 8192 /dev/urandom >foreign.db
expect 65 "$clast" run foreign.yaml
tiny nowhere
expect 74 "$clast" run nowhere.yaml --store no/such/folder/a.db
done_after 20
