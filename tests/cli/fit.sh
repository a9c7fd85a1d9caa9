#!/usr/bin/env bash
# clast fit: a fit of discs whose inputs are known, its runs in the store, going on after a kill, the ridge that one number
# leaves, what the documents' errors say.
. "$(dirname "$0")/lib.bash"

cat >disc.yaml <<'YAML'
name: disc
scene: disc-explosion
set: {body.diameter: 6 cm, charge.energy: 2 kJ/m, stop.end_time: 0.5 ms}
vary:
  threshold.strain: {log_uniform: [1 %, 8 %]}
  threshold.angle: {uniform: [1 deg, 8 deg]}
design: {kind: latin_hypercube, points: 10, seed: 3}
seeds: {per_point: 3}
store: disc.db
YAML
# A specimen of strain 4 %, angle 4 deg: seed 77, which the fit does not use.
"$clast" simulate disc-explosion --seed 77 --set body.diameter='6 cm' --set charge.energy='2 kJ/m' \
  --set stop.end_time='0.5 ms' --set threshold.strain='4 %' --set threshold.angle='4 deg' --json >specimen.json 2>err ||
  fail "no specimen"
value=$(python -c "
import re; text = open('specimen.json').read()
print(re.search(r'largest_fraction\W+?([0-9.e-]+)', text).group(1))")
cat >one.yaml <<YAML
name: one disc
source: a run of the program
shots:
  - measured:
      - {quantity: largest_fraction, value: $value, error: 0.01}
YAML

# Killed in the middle: the same command continues, and its report equals that of an uninterrupted fit.
"$clast" fit one.yaml disc.yaml --rounds 4 -j 1 --store killed.db >out 2>err &
for _ in $(seq 200); do
  [ "$(sqlite3 killed.db 'select count(*) from run' 2>/dev/null || echo 0)" -gt 5 ] && break
  sleep 0.05
done
kill -9 $! 2>/dev/null || true
wait $! 2>/dev/null || true
expect 0 "$clast" fit one.yaml disc.yaml --rounds 4 -j 2 --store killed.db --json
found=$(sed -nE 's/.* ([0-9]+) found in the store.*/\1/p' err)
[ "$found" -gt 0 ] || fail "nothing was found in the store"
mv out killed.json
expect 0 "$clast" fit one.yaml disc.yaml --rounds 4 -j 2 --json
says "0 found in the store"
cmp -s out killed.json || fail "a fit that was killed reports something else"
ok "killed and not killed: the same report"
# Nor do runs of the same points with seeds that they share change it, with their doubts.
sed 's/per_point: 3/per_point: 3, independent: false/' disc.yaml >alike.yaml
expect 0 "$clast" fit one.yaml alike.yaml --rounds 3 -j 2 --store left.db --quiet
expect 0 "$clast" fit one.yaml disc.yaml --rounds 4 -j 2 --store left.db --json
cmp -s out killed.json || fail "runs that the fit leaves out are in its report"
expect 0 "$clast" fit one.yaml disc.yaml --rounds 4 -j 2 --picture predicted.svg --keep-script
says "0 runs computed"
head -1 out | grep -qE '^threshold.strain [0-9.]+ \([0-9.]+ to [0-9.]+\) %, threshold' || fail "the first line does not answer"
prints "One experiment is one specimen"
prints "RESOLUTION: what a finer resolution would change is not known"
grep -q 'which is not known' predicted.gp || fail "no word on a resolution that is not known"
grep -q 'M₁/M' predicted.svg || fail "the picture has no readable label"
sed -i 's/^left_margin = .*/left_margin = 300/' predicted.gp # a quotient of whole numbers is whole: 300 / 900 was 0
gnuplot predicted.gp
grep -q 'M₁/M' predicted.svg || fail "no label beside a margin of whole pixels"
python - <<'PY'
import json
rows = json.load(open('killed.json'))
inputs = {r['name']: r for r in rows if r['kind'] == 'input'}
assert set(inputs) == {'threshold.strain', 'threshold.angle'}, inputs
for r in inputs.values():
    assert r['prior_05'] <= r['q05'] * 1.2 and r['q05'] < r['median'] < r['q95'] <= r['prior_95'] * 1.2, r
assert inputs['threshold.strain']['q05'] < 0.04 < inputs['threshold.strain']['q95'], inputs
datum, = [r for r in rows if r['kind'] == 'measured']
assert datum['q05'] < datum['value'] < datum['q95'] and 0.05 < datum['below'] < 0.95, datum
PY
ok "the interval holds the input that was taken, the prediction what was measured"
# The mean of 20 tough discs: M_1/M depends on both inputs, and one number cannot tell them apart.
sed -e 's/  - measured:/  - specimens: 20\n    measured:/' -e 's/value: [^,]*/value: 0.3/' one.yaml >twenty.yaml
expect 0 "$clast" fit twenty.yaml disc.yaml --rounds 4 -j 2 --store twenty.db
prints "RIDGE: these data cannot tell threshold.strain and threshold.angle apart"
prints "TOGETHER: the data determine threshold.strain and threshold.angle together"
tr '\n' ' ' <out | grep -qF "on either side of the ridge below: threshold.strain" || fail "the ends across a ridge, as if of each input"
# A column that is left out of a narrow table has no explanation.
expect 0 env COLUMNS=60 "$clast" fit twenty.yaml disc.yaml --rounds 4 -j 2 --store twenty.db
grep -q "not shown.*below" err && ! grep -q "below: share of" out || fail "a column that is not there is explained"
# Of these discs at most one in sixty stays whole, so the mean of twenty cannot be 0.99. The report does not tell in one
# line what the data determine and deny it in the next.
sed 's/value: [^,]*/value: 0.99/' twenty.yaml >whole.yaml
expect 0 "$clast" fit whole.yaml disc.yaml --rounds 3 -j 2 --store whole.db
head -1 out | grep -qF "OUTSIDE: no inputs within the priors give what was measured" || fail "OUTSIDE is not first"
grep -qE '^threshold.strain .*- +-$' out || fail "an interval that the ends of the priors make"
prints "MISFIT: no inputs within the priors predict largest_fraction well"
grep -qE 'The data determine|NOT DETERMINED|RIDGE' out && fail "a contradiction in the report"

# The rounds are campaigns that clast run can repeat; the first is the campaign itself.
expect 0 "$clast" status disc.db
same "$(sed 1d out | cut -c -21)" "       -  disc fit  f" "rounds are one row"
expect 0 "$clast" check disc.db
number disc.db "select document from campaign limit 1" >/dev/null
sqlite3 disc.db "select document from campaign order by campaign_id limit 1" >round.yaml
expect 0 "$clast" run round.yaml --store disc.db -j 2 --quiet --csv
same "$(number disc.db "select count(distinct substr(document, 1, instr(document, char(10)))) from campaign where document like '# Written by clast fit:%'")" "$(number disc.db "select count(*) / 30 from run")" "rounds of 30 runs"

# Several numbers of two shots, one a mean.
cat >two.yaml <<YAML
name: two discs
source: made up
shots:
  - name: weak
    set: {charge.energy: 1 kJ/m}
    measured:
      - {quantity: largest_fraction, value: 0.5, error: 0.02, resolution: 0.02}
      - {quantity: count_above, share: 0.05, value: 5}
      - {quantity: share_above, share: 0.05, value: 0.8, error: 0.05}
  - name: strong
    specimens: 2
    measured: [{quantity: dust_fraction, value: 0.3, error: 0.02, resolution: 0}]
YAML
expect 0 "$clast" fit two.yaml disc.yaml --rounds 3 --store two.db -j 2
prints "weak: fragments above"
same "$(number two.db "select count(distinct value) from point_input where path = 'charge.energy'")" 2 "energies of two shots"
same "$(number two.db "select count(*) from axis where path = 'charge.energy'")" 1 "an input that differs between shots is a column"

# The studies that it offers are whole commands, and tell what it lacks; of numbers above a mass there is none.
sed 's/, resolution: [0-9.]*//' two.yaml >unstudied.yaml
expect 0 "$clast" fit unstudied.yaml disc.yaml --rounds 3 --store two.db -j 2
tr '\n' ' ' <out | grep -qF 'Give `resolution` with the value, or as a share in `fragments:` (resolution: 10 %); no study tells it of fragments above a mass.' || fail "counts have no study"
tr '\n' ' ' <out | grep -o '`clast converge [^`]*`' | tr -d '`' >studies
same "$(wc -l <studies)" 2 "studies offered, one a shot"
while read -r study; do
  eval "expect 0 '$clast' ${study#clast} --knob time_step --seeds 2 --within off -j 2 --quiet"
done <studies
expect 0 "$clast" fit unstudied.yaml disc.yaml --rounds 3 --store two.db -j 2
tr '\n' ' ' <out | grep -qF 'counts as 0 for weak: fragments above 0.05 M, weak: mass share above 0.05 M.' || fail "a study that is offered tells nothing"
grep -qF 'a study tells it' out && fail "a study that was made is offered"
# The study of a rock of one's own names its file, and its inputs as they were written.
printf '%s\n' 'material: tuff' 'source: made up' 'like: gabbro' 'tillotson: {A: 20 GPa}' 'shear_modulus: 12 GPa' >rock.yaml
cat >own.yaml <<YAML
name: own
scene: disruption
set: {target.material: ./rock.yaml, fidelity.particles: 300, fidelity.projectile_spacing: 0.4, stop.end_time: 5 us}
vary: {impact.specific_energy: {log_uniform: [2 kJ/kg, 15 kJ/kg]}}
design: {kind: latin_hypercube, points: 20}
seeds: {per_point: 2}
YAML
printf '%s\n' 'name: m' 'source: made up' 'shots:' '  - set: {impact.angle: 30 deg}' \
  '    measured: [{quantity: largest_fraction, value: 0.5, error: 0.1}]' >shot.yaml
expect 0 "$clast" fit shot.yaml own.yaml --rounds 3 -j 2
study=$(tr '\n' ' ' <out | grep -o '`clast converge [^`]*`' | tr -d '`')
same "$study" "clast converge own.yaml --set 'impact.angle=30 deg' --set 'impact.specific_energy=2 kJ/kg' -Q largest_fraction" "the study of one's own rock"
eval "expect 0 '$clast' ${study#clast} --knob time_step --seeds 2 --within off -j 2 --quiet"
expect 0 "$clast" fit shot.yaml own.yaml --rounds 3 -j 2
grep -qF 'a study tells it' out && fail "a study that was made is offered"

# Numbers above a share of the body are those of the masses in the store: priors so narrow that all points are alike. The
# surface may tilt by a part of the scatter that three seeds leave in it.
sed 's/\[1 %, 8 %\]/[3.99 %, 4.01 %]/; s/\[1 deg, 8 deg\]/[3.99 deg, 4.01 deg]/' disc.yaml >narrow.yaml
expect 0 "$clast" fit two.yaml narrow.yaml --rounds 3 --store narrow.db -j 2 --json
python - <<'PY'
import array, json, math, sqlite3, statistics
rows = {r['name']: r['median'] for r in json.load(open('out')) if r['kind'] == 'measured'}
db = sqlite3.connect('file:narrow.db?mode=ro', uri=True)
runs = db.execute("select masses from fragment_mass join run using (run_id) join point_input i using (point_id)"
                  " where i.path = 'charge.energy' and i.value = 1000.0").fetchall()
counts, shares = [], []
for blob, in runs:
    masses = array.array('d', blob)
    heavy = [m for m in masses if m > 0.05 * sum(masses)]
    counts.append(math.log1p(len(heavy)))
    shares.append(sum(heavy) / sum(masses))
assert len(runs) == 90, len(runs)
assert abs(rows['weak: fragments above 0.05 M'] / math.expm1(statistics.mean(counts)) - 1) < 0.05, (rows, counts)
assert abs(rows['weak: mass share above 0.05 M'] / statistics.mean(shares) - 1) < 0.02, (rows, shares)
PY
ok "counts and shares are those of the masses"

# One more experiment, as it is predicted, lies in the range of each quantity, also where the scatter is wide.
sed 's/points: 10/points: 8/; /threshold.angle/d' disc.yaml >ends.yaml
cat >ends_measured.yaml <<YAML
name: both ends
source: made up
shots:
  - measured:
      - {quantity: largest_fraction, value: 0.1, error: 0.02, resolution: 0}
      - {quantity: dust_fraction, value: 0.9, error: 0.02, resolution: 0}
      - {quantity: share_above, share: 0.3, value: 0.02, error: 0.02, resolution: 0}
      - {quantity: count_above, share: 0.3, value: 0, resolution: 0}
YAML
expect 0 "$clast" fit ends_measured.yaml ends.yaml --rounds 3 --store ends.db -j 2 --json
python - <<'PY'
import json
rows = [r for r in json.load(open('out')) if r['kind'] == 'measured']
assert len(rows) == 4
for r in rows:
    most = 1e9 if 'fragments above' in r['name'] else 1
    assert 0 <= r['q05'] <= r['median'] <= r['q95'] <= most, r
assert any(r['q05'] == 0 or r['q95'] == 1 for r in rows), rows
PY
ok "predictions lie in the range of their quantity"
# A median and its quantiles have one mark.
expect 0 "$clast" fit ends_measured.yaml ends.yaml --rounds 3 --store ends.db -j 2
grep -qE '^threshold.strain +% +[0-9.]+ \([0-9.]+ to [0-9.]+\) ! ' out || fail "an input's quantiles have not one mark"
grep -qE '^largest_fraction .* [0-9.]+ \([0-9.]+ to [0-9.]+\) ! +[0-9.]+$' out || fail "predicted quantiles have not one mark"

# Error messages and their places.
sed 's/largest_fraction/largest_fractoin/' one.yaml >wrong.yaml
expect 65 "$clast" fit wrong.yaml disc.yaml
says "wrong.yaml:5"
says "largest_fraction"
expect 66 "$clast" fit none.yaml disc.yaml
expect 65 "$clast" fit disc.yaml disc.yaml
sed 's/^design:.*/design: grid/; s/{log_uniform: \(.*\)}/\1/; s/{uniform: \(.*\)}/\1/' disc.yaml >grid.yaml
expect 65 "$clast" fit one.yaml grid.yaml
says "latin_hypercube"
expect 64 "$clast" fit one.yaml
expect 64 "$clast" fit one.yaml disc.yaml --rounds 2
expect 0 "$clast" fit --help
prints "From 3 to 10"
# Data that waves along a line suit at several places: each place is known well, and the line is told with both ends.
cat >law.sh <<'SH'
#!/bin/sh
awk -v a="$1" -v b="$2" -v s="$3" -v n="$4" 'BEGIN { u = b - a + 0.03 * (a - 0.5) ^ 2
  y = 1 / (1 + exp(-4 * u * s)) + (s > 1 ? 0.25 * sin(10 * a) : 0) + substr(n, length(n) - 2) / 1e5
  printf "{\"y\": %.9g}\n", y }'
SH
chmod +x law.sh
cat >law.yaml <<'YAML'
engine: command
name: law
command:
  program: ./law.sh
  version: "1"
  arguments: ["{{a}}", "{{b}}", "{{s}}", "{{seed}}"]
  same_bits: true
  inputs:
    a: {default: 0.5, least: 0, most: 1, doc: First.}
    b: {default: 0.5, least: 0, most: 1, doc: Second.}
    s: {default: 1, least: 0, most: 9, doc: Speed.}
  results:
    y: {doc: Result.}
YAML
cat >line.yaml <<'YAML'
name: line
scene: ./law.yaml
vary: {a: {uniform: [0, 1]}, b: {uniform: [0, 1]}}
design: {kind: sobol, points: 20, seed: 2}
seeds: {per_point: 2}
store: line.db
YAML
cat >waves.yaml <<'YAML'
name: waves
source: made up
shots:
  - {name: slow, set: {s: 1}, measured: [{quantity: y, value: 0.505, error: 0.04, resolution: 0}]}
  - {name: fast, set: {s: 2}, measured: [{quantity: y, value: 0.505, error: 0.04, resolution: 0}]}
YAML
expect 0 "$clast" fit waves.yaml line.yaml --rounds 3 -j 2 --allow-commands --quiet
prints "RIDGE: a and b change together (correlation of the posterior 0.9"
same "$(tr '\n' ' ' <out | grep -o 'Surfaces through [0-9]*')" \
  "Surfaces through $(number line.db "select count(*) / 2 from point")" "points of the surfaces"
# A steep line: one input is known within a narrow range, though only together with the other.
sed -i 's/u = .*/u = 0.25 * (b - 6 * (a - 0.42))/' law.sh
expect 0 "$clast" fit waves.yaml line.yaml --rounds 3 -j 2 --allow-commands --quiet --store steep.db
prints "RIDGE: a and b change together (correlation of the posterior 0.9"
! grep -q 'NOT DETERMINED' out || fail "an input of a line counts as one alone"
# A line whose ends the data tell, too, is still a line: a + b is known within 0.01, a - b within 0.25.
sed -i 's/u = .*/u = 0/; s/y = .*/y = (s > 1 ? a - b : a + b) + substr(n, length(n) - 2) \/ 1e5/' law.sh
sed 's/{s: 1}, measured: .*/{s: 1}, measured: [{quantity: y, value: 1, error: 0.01, resolution: 0}]}/
  s/{s: 2}, measured: .*/{s: 2}, measured: [{quantity: y, value: 0, error: 0.25, resolution: 0}]}/' waves.yaml >ends.yml
expect 0 "$clast" fit ends.yml line.yaml --rounds 3 -j 2 --allow-commands --quiet --store known.db
prints "RIDGE: a and b change together (correlation of the posterior -"
grep -q 'may depend on the points' <(tr '\n' ' ' <out) || fail "the priors are told to end a line that the data end"
! grep -q 'determine all inputs' out || fail "inputs of a line are told to be determined"

# A seed moves y alike at all points (standard deviation 0.058). Seeds 4 and 5 for all points are one pair of specimens,
# 0.008 apart. With seeds of its own for each point the scatter is known, and the interval holds the 0.5 behind the specimen
# 0.46. Runs whose seeds are shared are left out: the answer is that of an empty store.
cat >law.sh <<'SH'
#!/bin/sh
awk -v a="$1" -v n="$4" 'BEGIN { h = 43758.5453 * sin(12.9898 * substr(n, length(n) - 5)); printf "{\"y\": %.9g}\n", a + 0.1 * (h - int(h)) }'
SH
sed 's/, b: .*/}/; s/per_point: 2/per_point: 2, first: 4/' line.yaml >own.yaml
sed 's/first: 4/first: 4, independent: false/' own.yaml >shared.yaml
printf 'name: pair\nsource: made up\nshots: [{measured: [{quantity: y, value: 0.46, error: 0.01, resolution: 0}]}]\n' >pair.yaml
expect 0 "$clast" fit pair.yaml shared.yaml --rounds 3 -j 2 --allow-commands --store pair.db
prints "SEEDS: all points share 2 seeds, which move y alike"
! grep -q 'left out' err || fail "a fit says that it leaves out its own runs"
same "$(number pair.db "select count(distinct seed) from run")" 2 "seeds that all points share"
expect 0 "$clast" fit pair.yaml own.yaml --rounds 3 -j 1 --allow-commands --store pair.db --json
says "0 found in the store"
same "$(number pair.db "select count(distinct seed) from run where seed > 9")" "$(number pair.db "select count(*) from run where seed > 9")" "seeds of its own"
mv out alone.json
expect 0 "$clast" fit pair.yaml own.yaml --rounds 3 -j 2 --allow-commands --store own.db --json
cmp -s out alone.json || fail "runs with shared seeds are in the answer"
python - <<'PY'
import json
a, y = json.load(open('out'))
assert a['q05'] < 0.5 < a['q95'], a
assert 0.045 < y['sd_seeds'] < 0.072, y  # 60 pairs tell it within 9 %
PY
ok "the scatter of seeds that act alike"
done_after 49
