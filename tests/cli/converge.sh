#!/usr/bin/env bash
# clast converge: a cheap study of each engine, its rows in the store, going on after it, and wrong command lines.
. "$(dirname "$0")/lib.bash"

disc=(disc-explosion --set body.diameter='8 cm' --set charge.energy='2 kJ/m' --set stop.end_time='1 ms')
expect 0 "$clast" converge --list
prints "particles"; prints "grains"
expect 0 "$clast" converge "${disc[@]}" --knob time_step --knob grains=1.2cm,1.069cm,0.9cm -Q largest_fraction,broken \
  --seeds 4 --max-seeds 8 --within '0.01 %' --store disc.db --picture disc.png -j 2
says "56 runs computed"; prints "largest number of seeds"; prints "grains"; [ -s disc.png ] || fail "no picture"
head -3 out | tr '\n' ' ' | grep -Eq 'Error of the resolution: [^(]*\((time_step|grains) [^)]*, (time_step|grains) [^)]*\)\. ' || fail "no error of both knobs"
same "$(number disc.db "select count(*) from convergence where n = 8")" 16 "levels of two knobs and two quantities"
same "$(number disc.db "select count(*) from convergence_limit")" 4 "limits"
# The bias that the study printed is the one of the runs themselves, seed by seed.
python - <<'PY'
import sqlite3, statistics
db = sqlite3.connect('file:disc.db?mode=ro', uri=True)
def values(point):
    return [v for v, in db.execute('select largest_fraction from run where point_id = ? order by seed', (point,))]
rows = db.execute("select knob, reference, point_id, bias, mean, n, paired, base from convergence"
                  " where quantity = 'largest_fraction' and n > 0 order by knob, level").fetchall()
checked = 0
for knob in ('grains', 'time_step'):
    mine = [r for r in rows if r[0] == knob]
    reference, = [r for r in mine if r[1]]
    assert sum(r[7] for r in mine) == 1, mine
    for r in mine:
        a, b = values(r[2]), values(reference[2])
        assert r[5] == len(a) == 8 and abs(statistics.mean(a) - r[4]) < 1e-12, r
        assert abs(statistics.mean(a) - statistics.mean(b) - r[3]) < 1e-12, r
        checked += 1
assert checked == 8, checked
PY
ok "mean and bias are those of the runs"
# The same command computes nothing; a later one continues the study.
expect 0 "$clast" converge "${disc[@]}" --knob time_step --knob grains=1.2cm,1.069cm,0.9cm --seeds 4 --max-seeds 8 \
  --within '0.01 %' --store disc.db --json -j 2
says "0 runs computed"
python -c "
import json; rows = json.load(open('out'))
assert len(rows) == 8 and {r['knob'] for r in rows} == {'time_step', 'grains'}, rows
assert all(r['bias'] == 0 for r in rows if r['reference'])
assert all(r['error'] <= max(r['mean'], 1 - r['mean']) for r in rows), rows"
ok "the table as JSON, in which no error of a share is larger than the share can move"
expect 0 "$clast" check disc.db
# An exponent belongs to all runs of a level: its study finds the beta and the interval that `estimates` prints.
expect 0 "$clast" estimates disc.db
prints "?"
expect 0 "$clast" converge "${disc[@]}" --knob time_step -Q beta_masses_from_2 --seeds 8 --within off --store disc.db -j 2
says "0 runs computed"; prints "quantity beta_masses_from_2"
expect 0 "$clast" estimates disc.db --json
python - <<'PY'
import json, sqlite3
db = sqlite3.connect('file:disc.db?mode=ro', uri=True)
rows = {r['point_id']: r for r in json.load(open('out')) if r['window'] == 'from_2'}
levels = db.execute("select point_id, mean, half_width, resolution from convergence where quantity = 'beta_masses_from_2' and n > 0").fetchall()
assert len(levels) == 5, levels
for point, mean, half_width, resolution in levels:
    row = rows[point]
    assert abs(row['beta_masses'] - mean) < 1e-9 and abs(row['beta_masses_hw95'] - half_width) < 1e-9, (row, mean)
    assert row['beta_masses_resolution'] >= resolution * (1 - 1e-9), row
    assert row['beta_masses_resolution_verdict'] != 'not-studied', row
    assert row['beta_least_squares_resolution_verdict'] == 'not-studied', row
PY
ok "exponents carry the error that their study found"
# The rounds are campaigns that clast run can repeat: every run is found.
python - <<'PY'
import sqlite3
db = sqlite3.connect('file:disc.db?mode=ro', uri=True)
text, = db.execute("select document from campaign where document like '%per_point: 8%' limit 1").fetchone()
open('round.yaml', 'w').write(text)
PY
expect 0 "$clast" run round.yaml --store disc.db -j 2
says "0 runs computed"

# SPH: the lattice is turned with the seed, and one round is enough without a width.
expect 0 "$clast" converge basalt-sphere --set fidelity.particles=300 --set stop.end_time='10 us' \
  --knob particles=200,300,450 --knob precision --seeds 3 --within off --store ball.db -Q mean_damage -j 2
prints "precision"; prints "one round"
says "marked (!), 12 of 12 runs: coarse" # the scene's own level belongs to two knobs, and counts once
same "$(number ball.db "select count(*) from run")" 12 "runs: 3 + 1 levels, 3 seeds"
# A scene without scatter: its seeds are equal, which study and plan say; chance is no word there. `estimates` leads to the
# campaign's quantity, which is no column of it.
printf '%s\n' 'name: plate' 'scene: porous-plate' 'set: {fidelity.points: 28, piston.speed: 350 m/s}' \
  'accuracy: {within: 200 %}' 'store: plate.db' >plate.yaml
expect 0 "$clast" converge plate.yaml --knob points=20,28,40 --seeds 3 --within off -j 2
tr "\n" " " <out | grep -q "All seeds of a level are equal: more of them tell no more." || fail "equal seeds: $(cat out)"
! grep -q "chance would" out || fail "chance in a study without scatter: $(cat out)"
expect 0 "$clast" plan plate.yaml --no-trial
prints "all 3 seeds of the study are equal with it: more of them tell no more"
expect 0 "$clast" run plate.yaml -j 2 --quiet
expect 0 "$clast" estimates plate.db
says "the main quantity of the campaign, shock_pressure, is no column here: \`clast stats plate.db\` has it"
# A knob whose runs are all equal tells nothing, so the error of the other one is not the whole.
cp ball.db equal.db
python - <<'PY'
import sqlite3
store = sqlite3.connect("equal.db")
store.execute("update convergence set resolution = iif(knob = 'precision', null, 0.1), open = (knob = 'precision')")
store.execute("update convergence_limit set verdict = iif(knob = 'precision', 'constant', 'limit')")
store.commit()
PY
same "$(number equal.db "select count(*) from resolution where verdict <> 'at-least'")" 0 "knobs that tell nothing, left out"
# Bodies that no setting moves: no difference is told, on every screen by the same word, and it is no error.
expect 0 "$clast" converge disc-explosion --set body.diameter='8 cm' --set charge.energy='1 J/m' \
  --set stop.end_time='0.1 ms' --knob grains=2cm,1.4cm,1cm --knob stop --seeds 3 --within off --store whole.db -j 2
prints "none seen. No difference seen (seeds): grains (3), stop (3)."
expect 0 "$clast" stats whole.db --studies -Q largest_fraction
prints "none seen"; says "no difference seen (resolution: grains, stop)"
same "$(number whole.db "select count(*) from resolution where half_width > 0 or verdict <> 'no-difference'")" 0 "equal runs, told as an error"
printf '%s\n' 'name: whole' 'scene: disc-explosion' 'store: whole.db' \
  'set: {body.diameter: 8 cm, charge.energy: 1 J/m, stop.end_time: 0.1 ms}' \
  'accuracy: {quantity: largest_fraction, within: 5 %}' >whole.yaml
expect 65 "$clast" plan whole.yaml
says "No run of the study differs between the settings"
same "$(number ball.db "select count(*) from point_input where path = 'target.turned' and value = 0")" 0 "points with a lattice that is not turned"

# Named settings of a scene: a level each, and SCENE@NAME for every command.
"$clast" scenes disc-explosion | sed "/^settings:/,\$d" >named.yaml # without its own
cat >>named.yaml <<'YAML'
settings:
  draft: {grain.spacing: 15 mm, fidelity.time_step: 2 us}
  reference: {grain.spacing: 9 mm}
YAML
expect 0 "$clast" converge named.yaml --set body.diameter='8 cm' --knob settings --knob grains=1.069cm,0.9cm --seeds 3 \
  --within off --store named.db -j 2
prints "standard *"; prints "reference ref"
same "$(number named.db "select count(*) from convergence where knob = 'settings' and error > 0")" 3 "errors of named settings"
same "$(number named.db "select count(*) from resolution")" 3 "points with a known error"
expect 0 "$clast" simulate named.yaml@draft --set body.diameter='8 cm' --all
prints "2×10^-6"
expect 66 "$clast" simulate named.yaml@drat
says "standard, draft, reference"
printf 'name: named\nscene: ./named.yaml@draft\nset: {body.diameter: 8 cm}\nseeds: {per_point: 1}\n' >draft.yaml
expect 0 "$clast" run draft.yaml --store named.db
says "1 found in the store"

# The choices of other codes: each sets what its column of the page says, and nothing else. Other scenes do not have them.
python - "$clast" "$source/tests/validation/sph_other_codes.md" <<'PY' || fail "the page and the settings differ"
import json, re, subprocess, sys
def inputs(scene):
    rows = json.loads(subprocess.check_output([sys.argv[1], 'explain', scene, '--json']))
    return {r['path']: str(r['value']) if isinstance(r['value'], str) else r['value'] for r in rows}
def cell(text):
    number = re.fullmatch(r'([0-9.]+)( GPa|)', text)
    return float(number[1] + ('e9' if number[2] else '')) if number else {'true': True, 'false': False, 'off': None}.get(text, text)
table = [[c.strip() for c in line.split('|')[1:-1]] for line in open(sys.argv[2]) if re.match(r'\| `\w+\.', line)]
own = inputs('basalt-sphere')
for k, code in enumerate(('opensph', 'miluphcuda', 'spheral')):
    said = {row[0].strip('`'): cell(row[2 + k]) for row in table if row[2 + k]}
    theirs = inputs('basalt-sphere@' + code)
    changed = {path: value for path, value in theirs.items() if own.get(path) != value}
    assert len(said) > 8 and changed == said, (code, changed, said)
PY
ok "settings as the page says"
expect 66 "$clast" explain disruption@opensph
says "it has standard, draft, reference"

# A campaign: every point is studied.
tiny tiny
expect 0 "$clast" converge tiny.yaml --knob integrator --seeds 2 --within off -j 2
same "$(number tiny.db "select count(distinct base_point_id) from convergence")" 4 "points studied"
expect 0 "$clast" stats tiny.db
says "points are of studies and searches"
cp tiny.db less.db # points without runs are in no table
# shellcheck disable=SC2046
expect 0 "$clast" exclude less.db $("$clast" query less.db 'select run_id from run where point_id = 1' --csv | tail -n +2) --reason none
expect 0 "$clast" stats less.db --csv
says "clast: $(awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "points") k = i; next } { n += $k } END { print n }' out) of these points are of studies and searches"

# Questions to a store with a campaign leave the points of studies out.
expect 0 "$clast" run tiny.yaml -j 2
expect 0 "$clast" stats tiny.db
says "pooled over threshold.angle, threshold.strain"
says "left out: 4 points that only studies and searches have"
expect 0 "$clast" stats tiny.db --studies
says "pooled over fidelity.integrator, threshold.angle, threshold.strain"
expect 0 "$clast" plot tiny.db tiny.png --x threshold.angle --by threshold.strain
says "left out: 4 points"
# A study that is stopped leaves points that no campaign has and that have no runs.
cp tiny.db planned.db
# The view of the studies is a table of the folder, too, of the chosen points alone.
expect 0 "$clast" export tiny.db tables --csv
same "$(tail -n +2 tables/resolution.csv | wc -l)" "$(number tiny.db 'select count(*) from resolution join points using (point_id) where not study')" "rows of resolution.csv"
expect 0 "$clast" export tiny.db tables --csv --point 1
same "$(tail -n +2 tables/resolution.csv | cut -d, -f1 | sort -u)" 1 "points of resolution.csv"
sqlite3 planned.db "insert into point select 1000, randomblob(16), null, engine, scene_name, scene from point limit 1;
  insert into point_input select 1000, path, value from point_input where point_id = (select min(point_id) from point)"
expect 0 "$clast" map planned.db planned.png
says "left out: 4 points"
expect 0 "$clast" estimates planned.db --csv
same "$(grep -c '^1000,' out)" 0 "rows of the planned point"

# Accuracy on demand: without a study the command is named; then the cheapest settings are taken, and their seeds run.
cat >sharp.yaml <<'YAML'
name: sharp
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
accuracy: {within: 0.05}
store: sharp.db
YAML
expect 65 "$clast" run sharp.yaml
says "\`clast converge sharp.yaml --quantity largest_fraction\`"
expect 0 "$clast" converge sharp.yaml --knob time_step --seeds 8 --max-seeds 8 --store sharp.db -j 2
expect 0 "$clast" plan sharp.yaml --json
python - <<'PY'
import json, sqlite3
plan = json.load(open('out'))
chosen, = [a for a in plan['alternatives'] if a['choice'] == 'chosen']
setting = chosen['setting']
if setting == "the scene's own":  # which alternative is cheapest depends on measured times
    setting, = sqlite3.connect('sharp.db').execute("select distinct setting from convergence where base = 1").fetchone()
open('setting', 'w').write(str(float(setting)))
assert plan['runs_least'] == chosen['seeds'] > 2, plan
assert all(a['point_cpu'] is None or a['point_cpu'] >= chosen['point_cpu'] for a in plan['alternatives'])
PY
ok "the plan takes the cheapest alternative"
expect 0 "$clast" plan sharp.yaml
prints "chosen"; prints "seeds a point"; prints "not studied, and not in this error: grains, integrator"; prints "in doubt (!)"; prints "runs: cut" # as at its own settings
expect 0 "$clast" run sharp.yaml -j 2 --csv
# The end of the run says whether the runs keep what the study promised.
expect 0 "$clast" stats sharp.db --campaign sharp -Q largest_fraction --csv
total=$(python -c 'import csv; r, = csv.DictReader(open("out")); q = "largest_fraction_"
print("%.3g" % (float(r[q + "hw95"]) + float(r[q + "resolution"])))')
expect 0 "$clast" run sharp.yaml
says "accuracy: 1 of 1 point is within 0.05 by interval over seeds and error of the resolution together; the largest error is $total"
# All runs of the store tell the scatter: with three times of it, more seeds are planned.
sqlite3 sharp.db ".backup wide.db"
sqlite3 wide.db "update run set largest_fraction = 0.2 + 3 * (largest_fraction - 0.2)"
"$clast" plan sharp.yaml --store sharp.db --json >narrow.json
"$clast" plan sharp.yaml --store wide.db --json >wide.json
python - <<'PY'
import json
narrow, wide = ({(a["knob"], a["setting"]): a for a in json.load(open(name))["alternatives"]} for name in ("narrow.json", "wide.json"))
chosen, = (key for key, a in narrow.items() if a["choice"] == "chosen")
assert (wide[chosen]["seeds"] or 1e9) > narrow[chosen]["seeds"], (narrow[chosen], wide[chosen])
PY
ok "more seeds by the runs of the campaign"
sqlite3 sharp.db ".backup missed.db"
sqlite3 missed.db "update run set largest_fraction = seed % 2"
expect 0 "$clast" run sharp.yaml --store missed.db
says "within 0.05 by interval over seeds"
says "the same command again takes more seeds"
grep -q "clast: accuracy: no limit" err && fail "a limit was seen"
# With a level without a limit as the error, that is said.
sqlite3 sharp.db ".backup open.db"
sed 's/0.05/0.9/' sharp.yaml >loose.yaml
sqlite3 open.db "update convergence set open = 1"
expect 0 "$clast" run loose.yaml --store open.db
says "clast: accuracy: no limit is seen at 1 of them"
same "$(number sharp.db "select value from campaign join campaign_point using (campaign_id) join point_input using (point_id) \
  where name = 'sharp' and path = 'fidelity.time_step'")" "$(cat setting)" "time step of the campaign's point"
sed 's/{within: 0.05}/{quantity: beta_masses_from_2, within: 9}/' sharp.yaml >beta.yaml
expect 65 "$clast" plan beta.yaml
says "--quantity beta_masses_from_2"
expect 0 "$clast" converge beta.yaml --knob time_step -Q beta_masses_from_2 --seeds 8 --within off --store sharp.db -j 2
expect 0 "$clast" plan beta.yaml
prints "chosen"
# The least error in a time: the campaign's own seeds give way, more time gives a smaller error, a short one is refused.
sed 's/^accuracy.*/seeds: 30/; s/sharp/timed/; s/^store.*/store: sharp.db/' sharp.yaml >timed.yaml
expect 0 "$clast" plan timed.yaml --within 5s -j 2 --json --no-trial
python - <<'PY'
import json
plan = json.load(open('out'))
chosen, = [a for a in plan['alternatives'] if a['choice'] == 'chosen']
assert plan['runs_least'] == chosen['seeds'] and chosen['point_cpu'] <= 10, plan
assert plan['error_in_the_time'] == chosen['total'] == min(a['total'] for a in plan['alternatives'] if a['total'])
assert plan['error_in_half_the_time'] >= plan['error_in_the_time'] >= plan['error_in_twice_the_time'] > chosen['error'] / 2
open('seeds', 'w').write(str(chosen['seeds']))
PY
ok "the plan takes the least error in the time"
expect 0 "$clast" plan timed.yaml --within 5s --no-trial
prints "In half of the time"
tr -s ' \n' ' ' <out | grep -q 'resolution [^ ]* (time_step) and the rest seeds' || fail "the knobs of the error: $(cat out)"
same "$(tr -s ' \n' ' ' <out | sed 's/ of processor time allowed//' | grep -o 's of processor time' | wc -l)" 1 "processor times of one plan"
python - <<'PY'
import re
said = open("out").read()
assert re.search(r"grains: (\d+)", said)[1] == re.search(r"steps of (\d+) grains", said)[1], said
PY
ok "one number of grains"
expect 0 "$clast" run timed.yaml --within 200ms -j 2
says "of processor time"
expect 0 "$clast" run timed.yaml --within 200ms -j 2
says "0 runs computed"
# The plan tells mean and scatter of all these runs, not those of the study.
expect 0 "$clast" plan timed.yaml --within 200ms --json --no-trial
python - <<'PY'
import json, sqlite3, statistics
chosen, = [a for a in json.load(open('out'))['alternatives'] if a['choice'] == 'chosen']
runs = [row[0] for row in sqlite3.connect('sharp.db').execute("select largest_fraction from run join campaign_point using (point_id) "
    "join campaign using (campaign_id) where name = 'timed' and not surplus")]
assert abs(chosen['mean'] - statistics.mean(runs)) < 1e-12 and len(runs) >= chosen['seeds'], (chosen, len(runs))
PY
ok "a plan of runs that are there"
expect 65 "$clast" run timed.yaml --within 1us -j 2
says "too short"
expect 64 "$clast" run timed.yaml --within 10
says "30min"
expect 64 "$clast" run timed.yaml --within 1h --seeds 5
says "leave seeds.per_point"
sed -i 's/0.05/1e-9/' sharp.yaml
expect 65 "$clast" run sharp.yaml
says "smallest error"
says "or ask for the least error in a time: \`clast plan sharp.yaml --within 10min\`"
# Gear's step is above the bound of its condition: its runs are marked, so that it is no option.
sed 's/set: {/&fidelity.time_step: 1.05 us, /; s/1e-9/0.1/; s/sharp/gear/' sharp.yaml >gear.yaml
expect 0 "$clast" converge gear.yaml --knob integrator --seeds 4 --max-seeds 4 -j 2
says "step: "
expect 0 "$clast" plan gear.yaml --no-trial
prints "the scene's own"
grep -q 'integrator *gear' out && fail "a marked setting is an option"
# A terminal gets it in lines of 100 columns, with its commands whole.
script -qec "$clast run sharp.yaml" /dev/null </dev/null | tr -d '\r' >out || true
[ "$(wc -l <out)" -gt 3 ] && [ "$(wc -L <out)" -le 100 ] || fail "lines on a terminal"
prints "\`clast plan sharp.yaml --within 10min\`"
# A share is one of the mean, as for --within of converge and find.
sed 's/1e-9/20 %/' sharp.yaml >share.yaml
expect 0 "$clast" plan share.yaml --no-trial --json
python - <<'PY'
import json, sqlite3
store = sqlite3.connect("sharp.db")
means = dict(store.execute(
  "select setting, mean from convergence where quantity = 'largest_fraction' and knob = 'time_step' and n > 0"))
# A setting that was the cheapest has the mean of all of its runs, those of the campaign, too.
of_runs = dict(store.execute(
  "select setting, avg(largest_fraction) from convergence join run using (point_id) where quantity = 'largest_fraction' "
  "and knob = 'time_step' and n > 0 and surplus = 0 group by setting"))
for a in json.load(open("out"))["alternatives"]:
    assert a["within"] == 0.2 * a["mean"], a
    assert a["setting"] == "the scene's own" or a["known"] == "extrapolated" or any(
        abs(a["mean"] - of[a["setting"]]) < 1e-12 for of in (means, of_runs)), a
assert len(set(means.values())) > 1, means
PY
ok "a share of the mean of each setting"
expect 0 "$clast" plan share.yaml --no-trial
prints "largest_fraction within 20 % of its mean: each setting by its own mean, column within"
grep -q ' % of its mean 0\.' out || fail "the share that the choice reaches: $(cat out)"
[ "$(wc -L <out)" -le 100 ] || fail "a wide table of a plan"

# Of several knobs, `plan` and `converge` tell the mean of the one with most seeds. Advice of seeds tells its cost.
sed 's/sharp/mean/' sharp.yaml >mean.yaml
expect 0 "$clast" converge mean.yaml --knob grains=1.2cm,1.069cm,0.9cm --seeds 8 --within off --store mean.db -j 2
expect 0 "$clast" converge mean.yaml --knob time_step --seeds 3 --within off --store mean.db -j 2
says "clast estimates mean.db"
expect 65 "$clast" plan mean.yaml --no-trial
python - <<'PY'
import re, sqlite3
db = sqlite3.connect("mean.db")
mean, = db.execute("select mean from convergence where base and n = 8").fetchone()
assert float(re.search(r"the scene's own +([0-9.e-]+) ", open("out").read())[1]) == float("%.3g" % mean), mean
best = re.search(r"mean is ([0-9.e-]+) \(([0-9]+) seeds", " ".join(open("err").read().split()))
assert any(best[1] == "%.4g" % m for m, in db.execute("select mean from convergence where n = " + best[2])), best
PY
ok "the mean of most seeds"

# Advice of seeds keeps the knobs of the study: others would bring errors of their own.
sed 's/sharp/narrow/; s/1e-9/0.006/' sharp.yaml >narrow.yaml
expect 0 "$clast" converge narrow.yaml --knob time_step,integrator --seeds 8 --within off --store narrow.db -j 2
expect 65 "$clast" plan narrow.yaml
grep -q '`clast converge narrow.yaml --knob integrator=[a-z,]* --knob time_step=[-0-9.e,s]* --max-seeds' err || fail "no knobs: $(cat err)"
ok "advice keeps the knobs"
# It tells its runs before the first one.
advice=$(tr '\n' ' ' <err | tr -s ' ' | grep -o '`clast converge narrow.yaml --knob [^`]*`')
advice=${advice#*clast }
eval "expect 64 \"\$clast\" ${advice%\`*} --seconds 1e-6"
says " more runs, about"

# Levels without the scene's own grains: mean and seeds are those of the level that is told.
sed 's/sharp/without/' sharp.yaml >without.yaml
expect 0 "$clast" converge without.yaml --knob grains=1.3cm,0.9cm --seeds 3 --within off --store without.db -j 2
expect 65 "$clast" run without.yaml
python - <<'PY'
import re, sqlite3
said = " ".join(open("err").read().split())
grains, mean = re.search(r"with grains = ([0-9.]+) m, whose mean is ([0-9.e-]+) ", said).groups()
there, = sqlite3.connect("without.db").execute("select mean from convergence where setting = ?", (grains,)).fetchone()
assert mean == "%.4g" % there, (there, said)
assert "--max-seeds 0" not in said, said
PY
ok "the mean of the level that is told"

# Studies at other settings count with --set, too, as without it: the same settings have the same error, the same part
# beyond it, and the same knobs.
sed 's/^accuracy.*/accuracy: {within: 0.9}/; s/sharp/set/' sharp.yaml >set.yaml
short=(--set fidelity.time_step='5e-07 s')
expect 0 "$clast" converge set.yaml --knob time_step,stop --seeds 4 --within off -j 2 --quiet
expect 0 "$clast" converge set.yaml "${short[@]}" --knob grains=1.4cm,1.2cm,1.069cm --seeds 4 --within off -j 2 --quiet
python - <<'PY' # no limit is seen in stop
import sqlite3
db = sqlite3.connect("set.db")
db.execute("update convergence set open = 1, resolution = 0.02, bias = 0.02 where knob = 'stop'")
db.commit()
PY
expect 0 "$clast" plan set.yaml --no-trial --within 5s --json
mv out without
expect 0 "$clast" plan set.yaml "${short[@]}" --no-trial --within 5s --json
python - <<'PY'
import json
(with_set,) = [a for a in json.load(open("out"))["alternatives"] if a["setting"] == "the scene's own"]
(without,) = [a for a in json.load(open("without"))["alternatives"] if a["knob"] == "time_step" and float(a["setting"]) == 5e-7]
assert without["beyond"] > 0, without
for column in ("error", "known", "beyond", "mean"):
    assert with_set[column] == without[column], (column, with_set, without)
PY
ok "one error with --set and without"
expect 65 "$clast" plan set.yaml --set fidelity.time_step='2e-06 s' --no-trial # a level, and no scene of a study
says "set.db has no study of largest_fraction that starts from the settings of this campaign. They are the level time_step = 2e-6 of"
expect 0 "$clast" run set.yaml "${short[@]}" --within 300ms -j 2
same "$(tr -s ' \n' ' ' <err | grep -o 'resolution [>=0-9. ]*([a-z_, ]*)' | cut -d'(' -f2)" \
  "$(tr -s ' \n' ' ' <err | grep -o '(resolution: [a-z_, ]*)' | cut -d' ' -f2- )" "knobs of the choice and of the end"

# One setting has one error on every screen, also after a later study of other levels. The scene's own level is not
# among these: it has no smaller error than finer ones, and is a bound only if the law tells it.
sed 's/^accuracy.*/accuracy: {within: 0.9}/; s/sharp/one/' sharp.yaml >one.yaml
expect 0 "$clast" converge one.yaml --knob time_step,grains,settings --seeds 6 --within off -j 2
expect 0 "$clast" converge one.yaml --knob grains=1.5cm,0.9cm,0.7cm --seeds 7 --within off -j 2 --json
mv out levels
expect 0 "$clast" converge one.yaml --knob grains=1.5cm,0.9cm,0.7cm --seeds 7 --within off -j 2
mv out table
expect 0 "$clast" estimates one.db --studies
mv out estimates
expect 0 "$clast" estimates one.db --studies --json
mv out points
expect 0 "$clast" plan one.yaml --no-trial
mv out plan
expect 0 "$clast" plan one.yaml --no-trial --json
python - <<'PY'
import json, re, sqlite3
db = sqlite3.connect("one.db")
errors = {r["point_id"]: (r["largest_fraction_resolution"], r["largest_fraction_resolution_verdict"])
          for r in json.load(open("points")) if r["largest_fraction_resolution"] is not None}
rows = db.execute("select knob, setting, point_id, base, step from convergence where quantity = 'largest_fraction' and (n > 0 or base)").fetchall()
point = {(knob, setting): of for knob, setting, of, *_ in rows}
own = next(of for _, _, of, base, _ in rows if base)


def same(error, known, of, told):
    assert abs(error - errors[of][0]) < 1e-12 and known == (errors[of][1] == "known"), (told, errors[of])


for level in json.load(open("levels")):
    same(level["error"], level["error_verdict"] == "known", point[level["knob"], level["setting"]], level)
checked = 0
for option in json.load(open("out"))["alternatives"]:
    of = own if option["setting"] == "the scene's own" else point.get((option["knob"], option["setting"]))
    if of and option["known"] != "extrapolated":
        same(option["error"], option["known"] == "yes", of, option)
        checked += 1
assert checked > 6, checked
(step,) = [s for knob, _, _, base, s in rows if knob == "grains" and base]
for knob, setting, of, _, of_step in rows:
    assert knob != "grains" or of_step > step or errors[of][0] <= errors[own][0] * (1 + 1e-9), (setting, step, errors)
# People see the same two digits, and the same >=.
cell = ("" if errors[own][1] == "known" else ">= ") + "%.2g" % errors[own][0]
for screen, line in (("table", r"grains +0.01069 m \*"), ("plan", "the scene's own"), ("estimates", r"(^| )%d  +\d+  +\d\.\d+ (±|≥|\()" % own)):
    (line,) = [found for found in open(screen) if re.search(line, found)]
    assert re.search("(^| )" + re.escape(cell) + "( |$)", line.rstrip()), (screen, line, cell)
# best: of all levels of the scene in the store, also after later studies; the table tells the same.
def check_best(levels):
    for a in levels:
        told = None not in (a["error"], a["cpu"])
        beaten = told and any(b["error"] <= a["error"] and b["cpu"] <= a["cpu"] and (b["error"], b["cpu"]) != (a["error"], a["cpu"])
                              for b in levels if None not in (b["error"], b["cpu"]))
        assert a["frontier"] == (told and not beaten), a


stored = dict(((k, s), f) for k, s, f in db.execute("select knob, setting, frontier from convergence where quantity = 'largest_fraction'"))
assert all(a["frontier"] == stored[a["knob"], a["setting"]] for a in json.load(open("levels"))), stored
db.row_factory = sqlite3.Row
check_best(db.execute("select * from convergence where quantity = 'largest_fraction'").fetchall())
sentence = re.search(r"^grains = (\S+) m: .* Error of the resolution: (\S+) ", " ".join(open("table").read().split()))
assert sentence[2] == "%.2g" % errors[point["grains", sentence[1]]][0], (sentence, errors)  # of the finest level
PY
ok "one setting, one error"
# No limit is known: the error is told as a lower bound, by stats as well, and a run tells that of its own points.
python - <<'PY'
import sqlite3
db = sqlite3.connect("one.db")
db.execute("update convergence set open = 1 where knob = 'grains'")
db.execute("update convergence set resolution = 0.1 * resolution")
db.commit()
PY
expect 0 "$clast" stats one.db --by fidelity.time_step --studies
grep -Eq ' >= 0\.[0-9]+( |$)' out || fail "no >= in the column of the resolution"
expect 0 "$clast" run one.yaml --within 300ms -j 2
says "seeds a point: "
same "$(tr -s ' \n' ' ' <err | grep -o 'resolution [>=0-9. ]*([a-z_, ]*)' | cut -d'(' -f2)" \
  "$(tr -s ' \n' ' ' <err | grep -o '(resolution: [a-z_, ]*)' | cut -d' ' -f2- )" "knobs of the choice and of the end"
grep -q 'studied at' err && fail "the error of other points"
# A study of an earlier program has no row of the own level. Then the error of the next coarser level bounds its own.
python - <<'PY'
import sqlite3
db = sqlite3.connect("one.db")
db.execute("delete from convergence where knob = 'grains' and base")
db.execute("update convergence set open = 0")
db.execute("update convergence set resolution = 0.001 where knob <> 'grains'")
db.commit()
PY
expect 0 "$clast" plan one.yaml --no-trial
grep -q "the scene's own .* yes" out || fail "an own level between studied ones has no bound"
grep -q 'chosen *\(grains\|settings\)' out || fail "a setting without a known error is chosen"
# The advice of finer levels has the scene's own one.
python - <<'PY'
import sqlite3
db = sqlite3.connect("without.db")
db.execute("update convergence set open = 1")
db.commit()
PY
expect 65 "$clast" plan without.yaml
says "grains=0.018m,0.009m,0.0045m,0.01069m\`"

# Points of a file are scenes like those of axes.
printf 'threshold.strain,threshold.angle\n2 %%,2 deg\n5 %%,6 deg\n' >points.csv
cat >file.yaml <<'YAML'
name: file
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
design: {file: points.csv}
seeds: {per_point: 2}
store: file.db
YAML
expect 0 "$clast" converge file.yaml --knob grains=1.8cm,1.4cm --seeds 2 --within off -j 2
says "8 runs computed"

# The advice of a table that was not studied can be typed: its study belongs to these points.
tiny advised
expect 0 "$clast" run advised.yaml --quiet --set charge.energy='3 kJ/m' --store 'its store.db' -j 2
expect 0 "$clast" stats 'its store.db'
advice=$(tr '\n' ' ' <err | grep -o '`clast converge [^`]*` measures it')
same "$advice" '`clast converge --set '\''charge.energy=3 kJ/m'\'' --store '\''its store.db'\'' advised.yaml -Q largest_fraction` measures it'
advice=${advice#*clast } advice=${advice%\`*}
eval "expect 0 \"\$clast\" $advice --knob time_step --seeds 2 --within off -j 2"
expect 0 "$clast" stats 'its store.db'
says "resolution: time_step"

# Time that is spent before the first run ends the study.
expect 64 timeout -k 1 30 "$clast" converge "${disc[@]}" --knob time_step --seconds 1e-9 --store spent.db -j 2
says "too short for"; one_error

# The scene's own level takes minutes, the coarser ones 20 ms: they are studied, and the law tells its error.
expect 0 "$clast" converge disc-explosion --set body.diameter='14 cm' --set grain.spacing='0.06 cm' --seconds 20 \
  --knob grains=3cm,2.2cm,1.6cm,0.06cm --max-seeds 8 --store slow.db -j 1
tr "\n" " " <out | grep -qF "there was no time for 0.0006 m *, whose error" || fail "why the own level is missing: $(cat out)"
same "$(number slow.db "select min(n) from convergence where n > 0")" 8 "seeds of the coarser levels"
# A level that does not fit into the time has one reason, also where the others end for another one.
expect 0 "$clast" converge disc-explosion --set body.diameter='14 cm' --seconds 20 \
  --knob grains=3cm,2.2cm,1.6cm,0.06cm --seeds 8 --within off --store slow.db -j 1
tr '\n' ' ' <out | grep -q 'ended: one round was asked for; without [0-9.]* m \*.*; there was no time for 0.0006 m' || fail "why a level is missing: $(cat out)"

# The own level of a knob without time has the results of another knob, or of a campaign: it is no failed one.
expect 0 "$clast" converge disc-explosion --set body.diameter='14 cm' --set stop.end_time='1 ms' --knob grains=1.069cm,0.06cm \
  --knob time_step=2us,1us --seeds 2 --within off --seconds 10 --store own.db -j 1
tr '\n' ' ' <out | grep -qF "there was no time for 0.0006 m; with results, but a comparison takes two levels with 2 seeds: 0.01069 m *" ||
  fail "why the own level is not compared: $(cat out)"
printf '%s\n' 'name: late' 'scene: disc-explosion' 'set: {stop.end_time: 0.1 ms, charge.energy: 2 kJ/m}' \
  'vary: {body.diameter: [6 cm, 60 cm]}' 'seeds: {per_point: 2}' 'store: late.db' >late.yaml
expect 0 "$clast" run late.yaml --quiet
expect 0 "$clast" converge late.yaml --knob grains=1.069cm,0.12cm --seeds 2 --within off --seconds 10 -j 1
# Runs that fail are no lack of time.
tr '\n' ' ' <out | grep -qF "one round was asked for; run, but without a usable result: 0.0012 m" || fail "why a level is missing: $(cat out)"

# A setting finer than any level has the law's error on every screen.
cat >finer.yaml <<'YAML'
name: finer
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms, fidelity.time_step: 0.5 us}
accuracy: {quantity: largest_fraction, within: 0.17}
store: finer.db
YAML
expect 0 "$clast" converge finer.yaml --knob grains --seeds 32 -j 2
expect 0 "$clast" run finer.yaml -j 2
says "grains = 0.003795"
error=$(number finer.db "select round(resolution, 6) from convergence where reference")
same "$(number finer.db "select round(half_width / sqrt(0.5), 6) from resolution join point_input using (point_id)
  where path = 'grain.spacing' and value = 0.003795 and verdict = 'known'")" "$error" "error of a finer setting"
expect 0 "$clast" estimates finer.db
says "(resolution: grains)"
# More seeds: no number when the middle of the interval is out of reach. A smaller study does not replace a larger one.
sed 's/within: 0.17/within: 0.03/' finer.yaml >tight.yaml
expect 65 "$clast" plan tight.yaml --store finer.db
says "More seeds leave about 0.0"
says "Finer levels of grains, which leaves most of it (0."
# Runs tell that the finest grains are in doubt: finer ones are no choice, and no advice.
expect 0 "$clast" plan tight.yaml --store finer.db --no-trial --within 10s
prints "extrapolated"
cp finer.db doubted.db
sqlite3 doubted.db "update run set warnings = 'single' where point_id = (select point_id from convergence where reference)"
expect 0 "$clast" plan tight.yaml --store doubted.db --no-trial --within 10s
! grep -q extrapolated out || fail "a setting beyond a level in doubt is a choice: $(cat out)"
expect 65 "$clast" plan tight.yaml --store doubted.db --no-trial
! grep -q "Finer levels of grains" err || fail "finer levels in doubt are advised: $(cat err)"
expect 0 "$clast" converge finer.yaml --knob grains --seeds 8 --max-seeds 8
says "best: no other studied level of the scene has as small an error" # the legend tells the columns that are shown
# Levels whose runs are in doubt are no choice: `plan` says which and why, and with which input finer ones count.
cat >coarse.yaml <<'YAML'
name: coarse
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 0.5 ms}
accuracy: {quantity: largest_fraction, within: 0.01}
store: coarse.db
YAML
expect 0 "$clast" converge coarse.yaml --knob grains=10.69mm,5mm,2mm --seeds 3 --within off
expect 65 "$clast" plan coarse.yaml
says "Levels whose runs are in doubt do not count: grains = 0.002 m (3 of 3 runs: step"
says "\`clast converge coarse.yaml --set fidelity.time_step='1.25e-07 s' --knob grains=0.004m,0.002m,0.001m,0.01069m\`"
expect 65 "$clast" plan coarse.yaml --set 'fidelity.time_step=1 us'
says "\`clast converge coarse.yaml --set fidelity.time_step='1.25e-07 s' --knob" # one --set of an input
sed 's/within: 0.01/within: 0.9/' coarse.yaml >wide.yaml
expect 0 "$clast" plan wide.yaml --no-trial
prints "Left out, as their runs are in doubt (!) by a word that few of the scene's own have: grains = 0.002"
# Two studies with common levels are one line of the status, in which a common run counts once.
expect 0 "$clast" converge coarse.yaml --knob grains=10.69mm,5mm,3mm --seeds 3 --within off
expect 0 "$clast" status coarse.db
same "$(awk '/coarse grains/ { print $5, $6, $7 }' out)" "4 12 12" "points and runs of two studies with common levels"
# A study with fewer seeds and the same levels leaves the larger one in the store; one with another level takes its place.
expect 0 "$clast" converge coarse.yaml --knob grains=10.69mm,5mm --seeds 2 --within off
says "the study of grains in this store has 3 seeds, this one 2 and no other level: the store keeps that one. --seeds 3"
same "$(number coarse.db "select max(n) from convergence where knob = 'grains' and base")" 3 "seeds of the study that the store keeps"
! grep -q "0 more runs" err || fail "nothing to do is told: $(cat err)"
expect 0 "$clast" converge coarse.yaml --knob grains=10.69mm,5mm,3mm --seeds 3 --within off
! grep -q "takes its place" err || fail "a larger study replaces: $(cat err)"
expect 0 "$clast" converge coarse.yaml --knob grains=10.69mm,4mm --seeds 2 --within off
says "has 3 seeds, this one 2, but another level: it takes its place. --seeds 3"
same "$(number coarse.db "select max(n) from convergence where knob = 'grains' and base")" 2 "seeds of the study that took its place"
# The pages have the columns by the names of the table, and results where they speak of results.
tr -d '\n' <out >heads; cat err >>heads
for column in bias error best "share of upper mode"; do
  tr -s ' \n' ' ' <heads | grep -qF "$column" || fail "no column $column"
  grep -qF "**$column**" "$source/campaign/README.md" || fail "the page does not name the column $column"
done
"$clast" explain "$(grep -o 'the result itself (`[^`]*' "$source/campaign/accuracy.md" | cut -d'`' -f2)" >out
grep -q "^outcome:" out || fail "an input is told as a result"
ok "columns and results of the pages"
# A study of several points names each of them, for people and for programs.
printf 'name: each\nscene: disc-explosion\nset: {body.diameter: 6 cm, stop.end_time: 0.2 ms}\nvary: {threshold.strain: [1 %%, 3 %%]}\nstore: each.db\n' >each.yaml
expect 0 "$clast" converge each.yaml --knob integrator --seeds 2 --within off
prints "disc-explosion, strain 3 %, quantity largest_fraction"
expect 0 "$clast" converge each.yaml --knob integrator --seeds 2 --within off --csv
same "$(cut -d, -f1 out | sort -u | tr '\n' ' ')" "0.01 0.03 threshold_strain " "inputs of the levels"
expect 64 "$clast" converge each.yaml --knob integrator --seeds 2 --within off --picture each.svg
says "--picture draws the levels of a knob over its step"
expect 0 "$clast" converge each.yaml --knob time_step --seeds 2 --within off --picture each.svg
grep -q 'disc-explosion, strain 1 %: ' each.svg || fail "the title does not name the point"
says "a picture is of the first point, which its title names"
# --set of a varied input: one point is left, not the same one twice. It tells how much there is to do.
expect 0 "$clast" converge each.yaml --set threshold.strain='3 %' --knob time_step --seeds 3 --within off --store one.db
same "$(grep -c 'quantity largest_fraction' out)" 1 "points that differ"
says "1 point, 1 knob: the first 3 seeds of all levels take"
! grep -q "then more seeds" err || fail "more than one round is told"
# A study with rounds tells the most that all of them take: all levels with --max-seeds.
expect 0 "$clast" converge each.yaml --set threshold.strain='3 %' --knob time_step=2us,1us,0.5us --seeds 4 --max-seeds 8 --store most.db
says "seeds of all levels take 11 more runs, about"
says "then more seeds until every bias is narrow (--within): at most 23 runs, about"
error=$(tr '\n' ' ' <out | sed -n 's/.*Error of the resolution: \([^ ]*\) (time_step \([^ )]*\)).*/\1 \2/p')
same "${error% *}" "${error#* }" "error of the only knob"
! grep -q "from its limit" out || fail "the distance of the own level, told twice"
{ cat each.yaml && echo 'accuracy: {within: 0.9}'; } >wide.yaml
expect 0 "$clast" plan wide.yaml --store one.db
prints "other points have errors and means"
sed 's/3 %/4 %/' wide.yaml >other.yaml
expect 0 "$clast" plan other.yaml --store one.db
prints "the scene with its own values of what varies: largest_fraction"
# Of two studied points the one that needs most decides.
{ sed "s/3 %/4 %/" each.yaml && echo "accuracy: {within: 5 %}"; } >both.yaml
expect 0 "$clast" converge both.yaml --knob time_step=2us,1us --seeds 4 --within off --store two.db
python - <<'PY'
import sqlite3
db = sqlite3.connect("two.db")
db.execute("update convergence set open = 0, mean = 0.6, deviation = 1e-3, resolution = iif(base_point_id = "
           "(select min(base_point_id) from convergence), 0.01, 0.2)")
db.execute("update run set largest_fraction = 0.6 + 1e-3 * (seed % 2)")
db.commit()
PY
expect 65 "$clast" plan both.yaml --store two.db --no-trial
says "accuracy: by the study of point 2, strain 4 %, no setting gives"
sed 's/5 %}/50 %}/' both.yaml >each50.yaml
expect 0 "$clast" plan each50.yaml --store two.db --no-trial
! grep -q "other points have" out || fail "all points are studied: $(cat out)"
expect 0 "$clast" converge each.yaml --knob grains --seeds 2 --within off
same "$(grep -c 'is left out: ' err) $(grep 'is left out: ' err | sort -u | wc -l)" "2 2" "remarks on levels, each once"
# One sentence for a table: how many of its points do not converge, and the largest error of the others.
expect 0 "$clast" run each.yaml --seeds 2 --quiet --csv -j 2
python - <<'PY'
import sqlite3
db = sqlite3.connect("each.db")
db.execute("update convergence set open = 0, resolution = 0.0123, mean = 0.5 where quantity = 'largest_fraction'")
db.execute("update convergence_limit set verdict = 'limit'")
db.execute("update convergence_limit set verdict = 'no-limit' where base_point_id = (select min(base_point_id) from convergence)")
db.commit()
PY
expect 0 "$clast" stats each.db
says "resolution: does not converge at 1 of 2 points; the largest error of the others is 0.0"
python - <<'PY'
import sqlite3
db = sqlite3.connect("each.db")
db.execute("update convergence_limit set verdict = 'limit'")
db.execute("update convergence set open = 1 where base_point_id = (select min(base_point_id) from convergence)")
db.commit()
PY
expect 0 "$clast" stats each.db
says "no limit is seen at 1 of 2 points; the largest error is at least 0.0"
# A study with another time step has the error of that step, too, from the study that had it as a level.
printf 'name: steps\nscene: disc-explosion\nset: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}\nstore: steps.db\n' >steps.yaml
expect 0 "$clast" converge steps.yaml --knob grains=0.015m,0.012m,0.01m --knob time_step=2us,1us,0.5us -Q dust_fraction --seeds 4 --within off -j 2
expect 0 "$clast" converge steps.yaml --set fidelity.time_step=2us --knob grains=0.015m,0.012m,0.01m -Q dust_fraction --seeds 4 --within off -j 2
python - <<'PY'
import sqlite3
db = sqlite3.connect("steps.db")
(first,), (second,) = db.execute("select distinct base_point_id from convergence order by 1")
step, = db.execute("select resolution from convergence where base_point_id = ? and knob = 'time_step' and setting + 0 = 2e-6", [first]).fetchone()
rows = db.execute("select c.resolution, r.half_width, max(c.mean, 1 - c.mean) from convergence c join resolution r using (point_id, quantity) "
                  "where base_point_id = ? and not base and n > 0", [second]).fetchall()
assert step > 0 and len(rows) == 3, (step, rows)
for grains, whole, most in rows:
    assert abs(min(grains + step, most) - whole) < 1e-12, (grains, step, whole, most)
PY
ok "errors of the knobs of two studies"
# A weak interval has its mark in the table, too, and one that ends at 0 its ends.
expect 0 "$clast" converge steps.yaml --set threshold.strain='12 %' --knob grains=0.015m,0.012m,0.01m -Q dust_fraction --seeds 4 --within off --store weak.db -j 2
grep -Eq '^grains +0\.015 m +4 +0\.[0-9]+ \(0 to 0\.[0-9]+\)~' out && grep -Eq '^grains +0\.012 m +4 +0\.[0-9]+ ± 0\.[0-9]+~' out || fail "weak intervals of levels: $(cat out)"
# A knob of numbers without a law has no bound on any screen: a run that waits longer breaks more.
expect 0 "$clast" converge steps.yaml --knob stop,integrator -Q dust_fraction --seeds 4 --within off --store stop.db -j 2
prints "stop: no law says how far it is from a limit"
grep -Eq '^stop +[0-9.e-]+ s ref .* >= ' out || fail "the finest level of stop has a bound: $(cat out)"
same "$(number stop.db "select count(*) from resolution where verdict <> 'at-least'")" 0 "settings with a bound"
{ sed '/^store/d' steps.yaml && printf '%s\n' 'accuracy: {quantity: dust_fraction, within: 0.9}' 'store: stop.db'; } >waits.yaml
expect 0 "$clast" plan waits.yaml --no-trial
prints "no limit is seen in stop: total adds"
! grep -Eq '^(chosen)? +stop .* yes' out || fail "stop, told as known: $(cat out)"
sed 's/0.9/1e-5/' waits.yaml >waits5.yaml
expect 65 "$clast" plan waits5.yaml --no-trial
says "Finer levels of stop, which leaves most of it ("
# Withheld results are no lack of time, and to study them again is no advice.
printf '%s\n' 'name: dusty' 'scene: disruption@draft' 'set: {fidelity.particles: 1000, impact.specific_energy: 1 kJ/kg}' \
  'accuracy: {quantity: dust_fraction, within: 5 %}' 'store: dusty.db' >dusty.yaml
expect 0 "$clast" converge dusty.yaml --knob particles=500,1000 -Q dust_fraction --seeds 2 --within off -j 2
prints "run, but results are withheld (dust): 500, 1000 *"
expect 65 "$clast" plan dusty.yaml --no-trial
says "with its own settings, 2 of 2 runs are withheld. dust: take more particles, or give a larger fragments.dust_mass"
expect 0 env COLUMNS=50 "$clast" converge finer.yaml --knob grains --seeds 8 --max-seeds 8
! grep -q "best: " err || fail "the legend tells a column that is left out"
same "$(number finer.db "select max(n) from convergence")" 32 "seeds of the larger study"

expect 64 "$clast" converge
expect 64 "$clast" converge disc-explosion --knob particles
says "grains"
expect 64 "$clast" converge disc-explosion --knob grains=many,2
expect 64 "$clast" converge disc-explosion --within wide
expect 64 "$clast" converge disc-explosion -Q largest_fraction,broken --within 0.1
expect 64 "$clast" converge disc-explosion --set contact.friction
expect 65 "$clast" converge block-impact --knob grains=1cm
printf 'name: bad\nscene: disc-explosion\nvary: {grains: [1]}\n' >bad.yaml
expect 65 "$clast" converge bad.yaml --list
says "bad.yaml:3" # the campaign's own error
expect 66 "$clast" converge disc-explosoin
[ ! -e block-impact-converge.db ] || fail "a refused study made a store"

# A first run that dies ends the study: it has no time to plan with.
printf 'engine: command\nname: dies\ncommand:\n  program: /bin/false\n  version: "1"\n  inputs:
    n: {kind: count, default: 8, least: 2, most: 99, resolution: larger, doc: Number.}\n  results: {x: {doc: Result.}}\n' >dies.yaml
expect 1 timeout 60 "$clast" converge dies.yaml --allow-commands -Q x --seeds 2
says "ended without a result"

# Of a scene, --list has the knobs that it has levels of. A result that is withheld at its own settings is named before.
expect 0 "$clast" converge uniaxial --list
prints "time_step"
grep -q '^stop ' out && fail "a knob that does not apply"
says "not in this scene: stop does not apply"
expect 0 "$clast" converge disruption --set fidelity.particles=200 -Q dust_fraction --knob time_step=0.6,0.3 --max-seeds 4 -j 2
says "dust_fraction is withheld with the scene's own settings: fragments.dust_mass"
prints "ended: no two levels have"; ! grep -q "clast: next" err || fail "a step after no result"

# An exponent where nothing breaks. The own setting is known with fewer digits, too.
printf '%s\n' 'name: whole' 'scene: uniaxial' 'set: {body.columns: 4, body.rows: 6, threshold.breaking: false, loading.ramp: 0.1 ms,' \
  '  loading.strain_end: 0.01 %, loading.rate: 2 1/s}' 'accuracy: {quantity: beta, within: 5 %}' 'store: whole.db' >whole.yaml
expect 0 "$clast" converge whole.yaml -Q beta,young_modulus --knob time_step=1.000001us,2us --seeds 2 --within off -j 2
prints "1e-06 s *"
expect 65 "$clast" plan whole.yaml
says "too few fragments break off"
done_after 194
