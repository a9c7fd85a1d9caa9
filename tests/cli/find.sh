#!/usr/bin/env bash
# clast find: a crossing of discs, its runs in the store, going on after a kill, the same answer with one and two workers and
# under MPI, the other answers, and wrong command lines.
. "$(dirname "$0")/lib.bash"

cat >disc.yaml <<'YAML'
name: disc
scene: disc-explosion
vary: {threshold.strain: {from: 1 %, to: 6 %, n: 3}}
set: {body.diameter: 8 cm, charge.energy: 900 J/m, stop.end_time: 4 ms}
seeds: {per_point: 2}
store: disc.db
YAML
search=(disc.yaml --level 0.5 --share 50% --within "25 %")

expect 0 "$clast" find "${search[@]}" -j 1 --picture disc.png
[ -s disc.png ] || fail "no picture"
head -2 out | paste -sd ' ' | grep -qE '^The share of runs with largest_fraction above 0.5 rises through 0.5 at threshold.strain = [0-9.]+ %( !)? \(95 % interval [0-9.]+ % to [0-9.]+ %\)\.( |$)' ||
  fail "the first line is not the answer"
ok "the first line answers"
python - <<'PY' # places that are far apart have rows of their own: a second crossing could be between them
import re
rows = [tuple(map(float, row)) for row in re.findall(r'^ *([0-9.]+) % +([0-9.]+) % +[0-9]+ ', open('out').read(), re.M)]
assert len(rows) > 4 and max(high - low for low, high in rows) < 1, rows
PY
ok "rows of near places"
grep -oE '[0-9.]+ ± [0-9.]+' out | awk '$1 - $3 < 0 || $1 + $3 > 1 { exit 1 }' || fail "an interval of a share beyond 0 or 1"
says "at most 400 runs"; says "resolution: not studied"; prints "share above 0.5"
python - <<'PY' # the study is one of the crossing, in the units of the campaign
import re
at = re.search(r'at threshold.strain = ([0-9.]+) %', ' '.join(open('out').read().split())).group(1)
said = ' '.join(open('err').read().split())
assert f'largest_fraction at threshold.strain = {at} %: resolution: not studied' in said, (at, said)
study = re.search(r'`clast converge ([^`]*)`', said).group(1)
assert study.startswith("disc.yaml ") and f"threshold.strain={at} %" in study, study # the file has the rest, such as own rocks
PY
ok "the study advised is at the crossing"
runs=$(number disc.db "select count(*) from run")
# After the first round the width does not fall as the root of the runs, and no number of them is told.
expect 0 "$clast" find disc.yaml --level 0.5 --share 0.5 --within 0.002 --max-runs 20 --quiet
prints "a larger --max-runs goes on."; ! grep -q "needs about" out || fail "a number of runs after the first round"
expect 0 "$clast" status disc.db # its rounds are one row, with a name that can be typed
grep -q '^ *-  disc find threshold.strain ' out || fail "the rounds are no row of their name"
expect 0 "$clast" stats disc.db --campaign 'disc find threshold.strain'
expect 0 "$clast" find "${search[@]}" -j 2 --json
says "0 runs computed"; says "$runs found in the store"
cp out one.json
python - "$runs" <<'PY'
import json, sqlite3, sys
row, = json.load(open('one.json'))
assert list(row) == ['kind', 'quantity', 'level', 'share', 'input', 'unit', 'at', 'low95', 'high95', 'rising', 'narrow', 'from', 'to',
                     'runs', 'runs_without', 'doubtful', 'doubts'], list(row)
assert row['kind'] == 'crossing' and row['rising'] and row['narrow'] and row['runs'] == int(sys.argv[1]), row
assert row['from'] == 0.01 and row['to'] == 0.06 and row['high95'] - row['low95'] <= 0.25 * 0.05 + 1e-12, row
assert row['low95'] <= row['at'] <= row['high95'] and row['level'] == row['share'] == 0.5, row
# The ends of the interval are places where runs are, and every run has a seed of its own.
db = sqlite3.connect('file:disc.db?mode=ro', uri=True)
places = {v for v, in db.execute("select distinct value from point_input where path = 'threshold.strain'")}
assert {row['low95'], row['high95']} <= places, places
assert db.execute('select count(distinct seed) = count(*) from run').fetchone()[0] == 1
PY
ok "the keys and numbers of the row"
expect 0 "$clast" find "${search[@]}" -j 2 --json --store two.db
cmp -s out one.json || fail "two workers answer otherwise"
results="select threshold_strain, seed, largest_fraction, steps from runs order by 1, 2"
same "$(sqlite3 two.db "$results" | sha256sum)" "$(sqlite3 disc.db "$results" | sha256sum)" "the same bits with two workers"
expect 0 mpirun -n 2 "$clast" find "${search[@]}" --json --store mpi.db
cmp -s out one.json || fail "the answer under MPI is another"
expect 0 "$clast" check disc.db

# A search that is killed goes on, and answers as one that was not.
"$clast" find "${search[@]}" -j 1 --store killed.db >out 2>err &
for _ in $(seq 1000); do
  [ "$(sqlite3 killed.db 'select count(*) from run' 2>/dev/null || echo 0)" -gt 5 ] && break
  sleep 0.02
done
kill -9 $! 2>/dev/null || true
wait || true
[ "$(number killed.db 'select count(*) from run')" -lt "$runs" ] || fail "the search was over before the kill"
expect 0 "$clast" find "${search[@]}" -j 1 --store killed.db --json
cmp -s out one.json || fail "a search that was killed answers otherwise"
same "$(number killed.db 'select count(*) from run')" "$runs" "runs after a kill"

# A narrower interval goes on from these runs (64 more: between 68 and 140 runs its width falls nearly as their root); few runs end with
# a wide one.
expect 0 "$clast" find disc.yaml --level 0.5 --share 0.5 --within 0.002 --max-runs "$((runs + 64))"
says "$runs found in the store"; tr '\n' ' ' <out >line; mv line out
prints "a larger --max-runs goes on. The width asked for needs about "
expect 0 "$clast" find disc.yaml --level 0.5 --share 0.5 --within 1e-6 --max-runs "$((runs + 64))" --quiet
tr '\n' ' ' <out | grep -qF "A search may have at most 5000 runs; the width asked for needs more, " || fail "the width is beyond a search: $(cat out)"
! grep -qF -- "--max-runs" out || fail "advice that the next sentence forbids"
# Masses of discs are per metre.
expect 0 "$clast" find disc.yaml --level '0.5 kg/m' -Q mean_fragment_mass --max-runs 20
prints "kg/m"
# An interval that the bracket cuts is told.
expect 0 "$clast" find disc.yaml --level 0.5 --share 0.5 --from 2.5% --to 6% --max-runs 28
tr '\n' ' ' <out | grep -qF "The interval ends where the bracket does, and the crossing may be beyond it: a lower --from tells." || fail "the cut interval: $(cat out)"
# So at both ends, where a row's interval is weak. An angle that no campaign varies has its degrees.
sed 's/^vary.*/vary: {threshold.strain: [2 %, 5 %]}/; s/^set.*/set: {body.diameter: 8 cm, charge.energy: 2 kJ\/m}/' disc.yaml >weak.yaml
expect 0 "$clast" find weak.yaml --set threshold.angle='6 deg' --level 0.3 --within 0.1 --store weak.db --quiet
tr '\n' ' ' <out | grep -qF "beyond it: a lower --from and a higher --to tell." || fail "both ends: $(cat out)"
expect 0 "$clast" find weak.yaml --set threshold.strain='4 %' --input threshold.angle --from '2 deg' --to '6 deg' --level 0.3 --max-runs 20 --store angle.db --quiet
expect 0 "$clast" stats angle.db --by angle
prints "angle [deg]"
# Where the runs at an end lie on the other side, there may be another crossing, and not beyond the bracket.
sed 's/^vary.*/vary: {charge.energy: [0.3 kJ\/m, 30 kJ\/m]}/; s/^set.*/set: {body.diameter: 10 cm, threshold.angle: 4 deg}/; s/disc.db/peak.db/' disc.yaml >peak.yaml
expect 0 "$clast" find peak.yaml -Q second_fraction --level '5 %' --max-runs 20 --quiet
tr '\n' ' ' <out | grep -qE "crosses 0.05 at charge.energy above [0-9.]+ kJ/m, .* But the runs at 0.3 kJ/m lie on the other side: there may be another crossing\." || fail "the other end: $(cat out)"
grep -q "tells" out && fail "beyond the bracket is nothing to be seen"
# The last round takes what is left, to less than a run a place.
expect 0 "$clast" find disc.yaml --level 0.5 --within 0.0001 --max-runs 47 --store used.db --quiet
same "$(number used.db "select count(*) between 44 and 47 from run")" 1 "runs of 47"
# Other answers.
expect 0 "$clast" find disc.yaml --level 1
says "$(($(number disc.db "select count(*) from run") - $(grep -oE 'from all [0-9]+' out | tr -dc 0-9))) other runs at places of searches along threshold.strain"
prints "is below 1 for threshold.strain from 1 % to 6 %"; prints "no crossing in the"
grep -E '^clast: [0-9]+ runs' err | tail -1 | grep -q between && fail "an interval of no crossing"
grep -q "holds the level" err && fail "no mean is above 1"
says "largest_fraction at threshold.strain = 6 %: resolution: not studied" # the end that is nearest to the level
# No crossing is decided from all runs; the interval of a row's own runs may hold the level, which is said.
expect 0 "$clast" find disc.yaml --level 0.97 --store end.db
tr '\n' ' ' <out | grep -qF "no crossing in the bracket (95 %, from all $(number end.db 'select count(*) from run') runs)." || fail "how sure is not told"
says "the interval of one row holds the level; it comes from the runs of that row alone"
expect 66 "$clast" find disc-explosion --level 0.5
says "disc-explosion is a built-in scene; a campaign is a file"; one_error
expect 0 "$clast" find disc.yaml --level 1 --json
python -c "
import json; row, = json.load(open('out'))
assert row['kind'] == 'below' and row['narrow'] and row['at'] is row['low95'] is row['high95'] is row['rising'] is None, row"
ok "no crossing for programs"
expect 0 "$clast" find disc.yaml --level 0.5 --from 5% --to 6%
prints "is above 0.5 for threshold.strain from 5 % to 6 %"
says "largest_fraction at threshold.strain = 5 %: resolution: not studied"
# Behind --quiet are no remarks.
expect 0 "$clast" find disc.yaml --level 0.5 --from 5% --to 6% --quiet
grep -q 'one row\|resolution\|other runs\|level;' err && fail "remarks behind --quiet"
says "marked (!)"
# Equal runs bound the mean from below, as in the other tables.
sed 's/^vary.*/vary: {threshold.strain: [20 %, 30 %]}/; s/900 J/1 J/; s/4 ms/1 ms/; s/disc.db/whole.db/' disc.yaml >whole.yaml
expect 0 "$clast" find whole.yaml --level 0.5
prints "1.000 ≥ 0.473"; says "1.000 ≥ a: all runs are 1, and the mean is at least a"
# Of a whole number, the interval is one step. Mass grows with the columns, without noise.
cat >block.yaml <<'YAML'
name: block
scene: block-impact
vary: {body.columns: [4, 20]}
set: {body.rows: 4, stop.end_time: 0.01 ms}
seeds: {per_point: 2}
store: block.db
YAML
expect 0 "$clast" find block.yaml -Q total_mass --level '15 kg/m' --json
python - <<'PY'
import json, sqlite3
row, = json.load(open('out'))
assert row['kind'] == 'crossing' and row['high95'] == row['low95'] + 1 and row['narrow'] and row['rising'], row
db = sqlite3.connect('file:block.db?mode=ro', uri=True)
mass = dict(db.execute('select body_columns, avg(total_mass) from runs group by 1'))
assert mass[row['low95']] < 15 < mass[row['high95']], (row, mass)
PY
ok "the interval between two whole numbers"
# Runs in doubt mark the answer.
sed 's/stop.end_time: 4 ms/stop.end_time: 0.3 ms, fidelity.time_step: 4 us/; s/disc.db/coarse.db/' disc.yaml >coarse.yaml
expect 0 "$clast" find coarse.yaml --level 0.5 --max-runs 40
head -1 out | grep -q ' !' || fail "no mark"
says "marked (!), 35 of 40 runs: step: fidelity.time_step over"
# No answer without runs: the step is far too long.
sed 's/stop.end_time: 4 ms/&, fidelity.time_step: 1 ms/; s/disc.db/failed.db/' disc.yaml >failed.yaml
expect 1 "$clast" find failed.yaml --level 0.5 --max-runs 20
says "20 of the first 20 runs failed"
# Withheld results have their reason, as in tables.
printf '%s\n' 'name: dusty' 'scene: disruption@draft' 'set: {fidelity.particles: 500, stop.end_time: 20 us}' \
  'vary: {impact.specific_energy: [1 kJ/kg, 3 kJ/kg]}' >dusty.yaml
expect 65 "$clast" find dusty.yaml --level 0.4 -Q dust_fraction --max-runs 20 --quiet
says "withheld, 20 of 20 runs: dust: "; says "runs with a result are at 0 places"; one_error

# A reason that five values share is said once.
expect 65 "$clast" find dusty.yaml --level 0.4 --max-runs 20 --set specific_energy='1 kJ/kg' --input target.material.porosity.fraction --from 10% --to 40%
same "$(grep -c 'has no effect' err)" 1 "a reason that five values share"
says "point 5 of the design cannot be run for the same reason (at target.material.porosity.fraction 0.4)"
# Wrong command lines.
for wrong in "--share 0.5|--level is missing" "--level 1.5|at most 1, got 1.5" "--level nine|expected a number" "--level 0.5 -Q largest_friction|largest_fraction" "--level 3kg -Q mean_fragment_mass|expected a mass per length" \
  "--level 0.5 --input contact.law|not a number" "--level 0.5 --input charge.energy|no range of charge.energy" \
  "--level 0.5 --from 6% --to 1%|--from must be less than --to" "--level 0.5 --from 3|is a percentage" "--level 0.5 --share 2|between 0 and 1" \
  "--level 0.5 --within -1|above 0" "--level 0.5 --max-runs 3|from 20 to 5000"; do
  expect 64 "$clast" find disc.yaml ${wrong%%|*}
  says "${wrong#*|}"; one_error; silent out
done
# A mistyped input is first one that the campaign varies (rate is loading.rate, too, which has no effect here).
printf 'name: ring\nscene: ring-explosion\nvary: {expansion.rate: [60 1/s, 140 1/s]}\n' >ring.yaml
for wrong in "rat|expansion.rate" "densit|grain.density" "loading.rte|loading.rate"; do
  expect 64 "$clast" find ring.yaml --level 0.5 --input ${wrong%%|*}
  says "did you mean '${wrong#*|}'?"; one_error; silent out
done
sed 's/^vary: {/vary: {threshold.angle: [1 deg, 2 deg], /' disc.yaml >two.yaml
expect 64 "$clast" find two.yaml --level 0.5
says "varies 2 inputs: name one"
expect 64 "$clast" find two.yaml --level 0.5 --input strain
says "the campaign varies threshold.angle as well as threshold.strain"; says "--set threshold.angle=VALUE"
expect 64 "$clast" find two.yaml --level 0.5 --input strain --set young_modulus=1GPa
says "it may be 'grain.young_modulus', 'beam.young_modulus'"; one_error
expect 0 "$clast" find two.yaml --level 0.5 --input strain --set angle=4deg --max-runs 20 --store set.db
prints "The mean of largest_fraction"
expect 0 "$clast" find two.yaml --level 0.5 --input angle --from 2deg --to 6deg --set strain=3% --max-runs 20 --store set.db
same "$(number set.db "select group_concat(place, ' ') from (select distinct round(value * 57.29577951308232, 6) as place from point_input join campaign_point using (point_id) join campaign using (campaign_id) where path = 'threshold.angle' and name like '%angle' order by 1)")" "2.0 3.0 4.0 5.0 6.0" "places are round in degrees"
tr '\n' ' ' <err | grep -qE "'threshold.angle=[0-9.]+ deg'" || fail "the study advised is in other units: $(cat err)"
# A picture has the point of the bracket's end, also with nine runs there.
printf '%s\n' 'name: ex log' 'scene: disc-explosion' 'set: {body.diameter: 7 cm}' 'vary: {charge.energy: [0.2 kJ/m, 10 kJ/m]}' \
  'seeds: {per_point: 2}' 'store: exlog.db' >exlog.yaml
expect 0 "$clast" find exlog.yaml -Q second_fraction --level 0.12 --within '15 %' --max-runs 100 --quiet --picture e.svg --keep-script
grep -q '^10 0\.' e.dat && ! grep -q '^NaN [0-9]' e.dat || fail "the end of the bracket is not drawn: $(cat e.dat)"
ok "a picture has every place"
done_after 63
