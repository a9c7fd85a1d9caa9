#!/usr/bin/env bash
# Runs that must fail: a time step above stability, an energy that drifts, runs over their time or memory. Verdicts are
# rows, attempts are logged, the campaign goes on, and abandoned runs can be tried again.
. "$(dirname "$0")/../cli/lib.bash"

small=(--set "body.diameter=8 cm" --set "stop.end_time=1 ms")
expect 1 "$clast" simulate disc-explosion "${small[@]}" --set fidelity.time_step=1e-4s
says "fidelity.time_step"; one_error; prints "invalid"
expect 1 "$clast" simulate disc-explosion "${small[@]}" --set fidelity.energy_bound=1e-7% --json
says "energy"; prints '"state": "energy"'
expect 65 "$clast" simulate disc-explosion --set "body.diameter=1000 km"
says "too large"; one_error

# verdicts in a campaign: one point of two fails, the other does not
tiny verdict
sed -i 's/^vary:/vary: {fidelity.time_step: [1 us, 100 us]}/; /threshold/d' verdict.yaml
expect 1 "$clast" run verdict.yaml -j 2
says "failed"
same "$(number verdict.db "select group_concat(n || ':' || failed, ' ') from (select * from points order by fidelity_time_step)")" "3:0 0:3" "runs and failures of the points"
same "$(number verdict.db "select count(*) from runs where state = 'invalid' and message like '%time_step%'")" 3 "verdicts with their reason"
expect 1 "$clast" run verdict.yaml --quiet
same "$(number verdict.db "select count(*) from run")" 6 "a verdict is not computed again"

# warnings: printed before the run by simulate, plan and run, stored with the result, and counted
expect 0 "$clast" simulate disc-explosion "${small[@]}" --set charge.energy=3MJ/m --set fidelity.time_step=0.2us --json
says "warning: passing: the speed at which grains without a beam meet, over the speed at which they pass through each other, is 1.73, above 1"; prints '"warnings": "passing, single"'
expect 0 "$clast" simulate disc-explosion "${small[@]}" --set charge.energy=3MJ/m --set fidelity.time_step=0.2us --quiet
says "warning: passing:" # quiet is without progress, not without doubts
expect 0 "$clast" simulate disc-explosion --set body.diameter='8 cm' --set charge.energy='2 kJ/m' --set stop.least_time='1 ms'
if grep -q warning err; then fail "a warning of a safe run"; fi
tiny doubt
sed -i 's/^vary:/vary: {fidelity.time_step: [1 us, 5 us]}/; /threshold/d; s/stop.end_time: 1 ms/stop.end_time: 0.16 ms, threshold.breaking: false, fidelity.energy_bound: off/' doubt.yaml
expect 0 "$clast" plan doubt.yaml --no-trial
prints "warning   1 of 2 points: step: fidelity.time_step over the longest stable step is"
expect 0 "$clast" run doubt.yaml -j 2
says "warning: 1 of 2 points: step:"
said=$(sed -n 's/.*longest stable step is \([0-9.]*\), .*/\1/p' <(tr '\n' ' ' <err | tr -s ' '))
sed 's/1 us, 5 us/1 us, 5 us, 4 us/; s/doubt/worst/' doubt.yaml >worst.yaml
expect 0 "$clast" plan worst.yaml --no-trial
tr '\n' ' ' <out | tr -s ' ' | grep -qF "2 of 3 points, at worst: step: fidelity.time_step over the longest stable step is $said," || fail "not the worst of two points: $said"
same "$(number doubt.db "select group_concat((time_step * 1e6) || ':' || replace(warnings, ', ', '+'), ' ') from (select distinct time_step, warnings from run order by 1, 2)")" "1.0: 5.0:drift+step 5.0:step" "words in the store"
expect 0 "$clast" extremes doubt.db --json
prints '"warned": 3'
expect 0 "$clast" extremes doubt.db
prints "step"
expect 66 "$clast" extremes nosuch.db

# over its time limit
slow time; sed -i 's/14 cm/40 cm/; s/per_point: [0-9]*/per_point: 1/' time.yaml
echo 'limits: {time: 0.05 s, attempts: 2, failures: 0}' >>time.yaml
expect 1 "$clast" run time.yaml -j 2
says "attempts failed"
same "$(number time.db "select count(*) || ' ' || min(reason) || ' ' || max(reason) from attempt")" "6 time_limit time_limit" "attempts"
same "$(number time.db "select count(*) from run")" 0 "no run of them is stored"
expect 1 "$clast" run time.yaml --quiet
same "$(number time.db "select count(*) from attempt")" 6 "attempts that were used up are not made again"
expect 0 "$clast" status time.db --json
prints '"without_result": 3'
expect 1 "$clast" retry time.db --time "0.05 s" --quiet
same "$(number time.db "select count(*) from attempt")" 12 "a retry under the same limit makes as many attempts more"
expect 0 "$clast" retry time.db --status failed --time "100 s" -j 2
same "$(number time.db "select count(*) from runs where counts")" 3 "runs after the retry"
expect 64 "$clast" retry time.db --status elephant

# over its memory limit
slow memory; sed -i 's/14 cm/400 cm/; s/per_point: [0-9]*/per_point: 1/; s/\[2 %, 3 %, 5 %\]/[2 %]/' memory.yaml
echo 'limits: {memory: 8 MiB, attempts: 1, failures: 0}' >>memory.yaml
if [ "$sanitized" -eq 0 ]; then
  expect 1 "$clast" run memory.yaml -j 1
  same "$(number memory.db "select count(*) || ' ' || reason from attempt")" "1 memory_limit" "attempts"
else
  ok "(not tried: the sanitizers themselves need terabytes of address space)"
  ok "(nor this)"
fi

# too many of the first runs fail: the campaign stops and says so
tiny failures
sed -i 's/^vary:/vary: {fidelity.time_step: [100 us, 110 us]}/; /threshold/d; s/per_point: 3/per_point: 100/' failures.yaml
echo 'limits: {failures: 20}' >>failures.yaml
expect 1 "$clast" run failures.yaml -j 2
says "20"
[ "$(number failures.db "select count(*) from run")" -lt 60 ] || fail "it did not stop"
ok "stopped after $(number failures.db "select count(*) from run") runs of 200"
done_after 33
