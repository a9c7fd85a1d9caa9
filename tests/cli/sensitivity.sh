# Sensitivity indices from a campaign that the program wrote itself: files, runs, rows, and what is refused.
. "$(dirname "$0")/lib.bash"

cat >sweep.yaml <<'YAML'
# remarks stay
name: sweep
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 0.3 ms}
vary:
  threshold.strain: {uniform: [1 %, 6 %]}
  # the other one
  threshold.angle: {log_uniform: [2 deg, 6 deg]}
design:
  kind: sobol
  points: 8
seeds: {per_point: 2}
YAML

expect 0 "$clast" sensitivity sweep.yaml ask.yaml --design saltelli --blocks 4
grep -q '^vary:\|kind: sobol\|the other one' ask.yaml && fail "the old design is still there"
grep -q '^# remarks stay' ask.yaml && grep -q '^design: {file: "ask.csv"}' ask.yaml || fail "the document"
same "$(grep -c . ask.csv)" 17 "lines of the design"
same "$(head -1 ask.csv)" "threshold.strain,threshold.angle" "inputs of the design"
expect 64 "$clast" sensitivity sweep.yaml ask.yaml --design saltelli # loses nothing
says "ask.yaml exists already"

# No file is left of a design that cannot be written, or not be read in its new place.
mkdir taken.csv sub
expect 64 "$clast" sensitivity sweep.yaml taken.yaml --design saltelli --blocks 4
[ -e taken.yaml ] && fail "a document without its points"
cp "$source/engine/dem/scene/builtin/disc-explosion.yaml" own.yaml
sed 's/^scene: .*/scene: own.yaml/' sweep.yaml >near.yaml
expect 65 "$clast" sensitivity near.yaml sub/ask.yaml --design saltelli --blocks 4
says "sub/own.yaml: there is no such file"
same "$(ls sub)" "" "files that are left"
ok "no half design"
expect 0 "$clast" run ask.yaml --store ask.db -j 2 --quiet
expect 0 "$clast" sensitivity ask.db ask.yaml -Q fragment_count --csv
python - <<'PY'
import csv
rows = {r["input"]: r for r in csv.DictReader(open("out"))}
assert list(rows) == ["threshold.strain", "threshold.angle", "seed"], rows
assert 0 < float(rows["seed"]["total"]) < 1 and all(float(r["total"]) >= 0 for r in rows.values())
assert all(float(r["total_hw95"]) > 0 for r in rows.values())
PY
ok "indices of both inputs and of the seed"

# A block without a run is left out, and the output says so.
expect 0 "$clast" export ask.db less.db
python -c "
import sqlite3
db = sqlite3.connect('less.db')
db.execute('PRAGMA foreign_keys = OFF')
db.execute('UPDATE run SET counts = 0, surplus = 1 WHERE point_id = 3')
db.execute('UPDATE point_total SET runs = 0 WHERE point_id = 3')
db.commit()"
expect 0 "$clast" sensitivity less.db ask.yaml
says "1 of 4 blocks lack a finished run"
# Two seeds have no interval of their first order, which is then noise.
says "Two seeds are two values of one more input"
same "$(awk '$1 == "seed" { print $2 }' out)" - "first order of two seeds"

# ---- an input without effect is left out: it cannot come first, by chance
cat >idle.yaml <<'YAML'
name: idle
scene: disc-explosion
set: {body.diameter: 6 cm, stop.end_time: 0.1 ms}
vary: {threshold.strain: {uniform: [1 %, 6 %]}, contact.friction: {uniform: [0.1, 0.8]}}
design: {kind: latin_hypercube, points: 12}
seeds: 2
YAML
expect 0 "$clast" run idle.yaml -j 2 --quiet
expect 0 "$clast" sensitivity idle.db --csv
says "no effect at any of these points, and left out: contact_friction"
grep -q friction out && fail "an input without effect has a rank"
ok "friction without tangential damping"

# ---- inputs of a sample that follow each other by chance are told before it runs
sed -e '/^design/s/12/12, seed: 4/' -e '/^vary/s/contact.friction: {uniform: .0.1, 0.8./charge.energy: {log_uniform: [0.5 kJ\/m, 4 kJ\/m]/' idle.yaml >together.yaml
expect 0 "$clast" plan together.yaml --no-trial
tr -s '\n ' ' ' <out | grep -q "threshold.strain, charge.energy move together in these 12 points by chance: .* another design.seed, or more" || fail "no word on inputs that move together"
sed -i 's/seed: 4/seed: 3/' together.yaml
expect 0 "$clast" plan together.yaml --no-trial
! grep -q "move together" out || fail "inputs that are told apart"
ok "inputs that move together, before the run"

# ---- any points: a Latin hypercube with a linked axis, and what cannot be told
cat >latin.yaml <<'YAML'
name: latin
scene: disc-explosion
set: {body.diameter: 8 cm, stop.end_time: 0.3 ms, contact.tangential_damping: 1e4 1/s}
vary:
  threshold.strain: {log_uniform: [1 %, 6 %]}
  charge.energy: {log_uniform: [0.5 kJ/m, 4 kJ/m]}
  contact.friction: {uniform: [0, 0.8]}
  grain.young_modulus: {uniform: [0.9 GPa, 1.1 GPa]}
  beam.young_modulus: {linked: grain.young_modulus, factor: 0.5}
design: {kind: latin_hypercube, points: 40}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run latin.yaml -j 2 --quiet
expect 0 "$clast" sensitivity latin.db
grep -q "^Which input matters most is not sure: strain alone explains" out || fail "no short name"
prints "energy may matter as much"
tr "\n" " " <out | grep -q "between points" || fail "no word on the means"
[ "$(wc -L <out)" -le 100 ] || fail "a line of more than 100 columns"
expect 0 "$clast" sensitivity latin.db -Q fragment_count --csv
python - <<'PY'
import csv
rows = {r["input"]: r for r in csv.DictReader(open("out"))}
assert len(rows) == 6 and list(rows)[-1] == "seed", rows
assert [n for n, r in rows.items() if r["not_told"]] == ["grain_young_modulus"], rows
assert rows["grain_young_modulus"]["not_told"] == "as beam_young_modulus"
for name, r in rows.items():
    if not r["not_told"]:
        low, high = float(r["runs_low"]), float(r["runs_high"])
        assert 0 <= low <= high <= 1, r
told = [float(r["of_means"]) for r in rows.values() if r["of_means"]]
assert told == sorted(told, reverse=True) and len(told) == 4, told
assert float(rows["threshold_strain"]["of_means"]) > 0.2 and float(rows["contact_friction"]["means_low"]) < 0.1
PY
ok "first-order indices from any points"
expect 0 "$clast" sensitivity latin.db --where 'threshold_strain < 0.015'
prints "points are too few to tell which of 5 inputs matters: 15 would do."
expect 0 "$clast" sensitivity latin.db --campaign latin --json
python -c "import json; assert len(json.load(open('out'))) == 6"
expect 64 "$clast" sensitivity latin.db -Q nothing
expect 64 "$clast" sensitivity sweep.yaml --design saltelli
says "--design writes a campaign"
ok "what these points cannot tell"

# ---- one seed for all points: no scatter over seeds is in the shares, nor in a pooled interval
sed 's/per_point: 2/per_point: 1/; s/^name: .*/name: single/' latin.yaml >single.yaml
expect 0 "$clast" run single.yaml -j 2 --quiet
expect 0 "$clast" sensitivity single.db -Q fragment_count --csv
says "all points share one seed"
expect 0 "$clast" sensitivity single.db -Q fragment_count
tr "\n" " " <out | grep -q "at this one seed" || fail "shares of single runs of one seed"
! grep -Eq "scatter over seeds\. rank|of single runs\. rank" err || fail "the rest is told as the scatter over seeds"
shared="what a seed changes at all of them alike is not in the interval"
expect 0 "$clast" stats single.db -Q fragment_count
says "$shared"
expect 0 "$clast" spectrum single.db --by '' --picture one.png --keep-script
says "$shared"
grep '^caption_text' one.gp | sed "s/'\.\"\\\\n\"\.'/ /g" | grep -q "without what a seed changes" || fail "the caption of pooled spectra"
sed 's/per_point: 1/per_point: 1, independent: true/; s/^name: .*/name: own/' single.yaml >own.yaml
expect 0 "$clast" run own.yaml -j 2 --quiet
expect 0 "$clast" sensitivity own.db -Q fragment_count
tr "\n" " " <out | grep -q "of single runs" || fail "independent seeds"
expect 0 "$clast" stats own.db -Q fragment_count
"$clast" spectrum own.db --by '' >out 2>>err || fail "pooled spectra"
! grep -q "share seeds" err || fail "independent seeds are told as shared"
ok "seeds that points share"

# Pooled over an input that changes nothing: the interval is that of the seeds at one of its values. The points' means are
# all equal, and no number of points makes it narrower.
printf 'engine: toy\n' >stick.yaml
printf '%s\n' 'name: alike' 'scene: stick.yaml' 'vary: {stick.angle: [1 deg, 2 deg, 3 deg]}' 'seeds: 5' >alike.yaml
expect 0 "$toy" run alike.yaml --quiet
expect 0 "$toy" stats alike.db -Q largest_fraction --csv --where 'stick_angle < 0.02'
cut -d, -f8- out >one
expect 0 "$toy" stats alike.db -Q largest_fraction --csv
python - <<'PY'
import csv
one, pooled = (list(csv.DictReader(open(name)))[0] for name in ("one", "out"))
for name in "mean", "se", "hw95":
    a, b = (float(row["largest_fraction_" + name]) for row in (one, pooled))
    assert a > 0 and abs(b / a - 1) < 1e-12, (name, a, b)
assert float(pooled["largest_fraction_sd"]) < 1e-12
PY
expect 0 "$toy" stats alike.db -Q largest_fraction
! grep -q "share seeds" err || fail "the interval of a mean has the seeds' part"
ok "seeds of points that are alike"

# Two inputs that move together hide the effect of each other; a third one, told alone, is not the answer.
cat >line.yaml <<'YAML'
engine: command
name: line
command:
  program: awk
  version: "1"
  arguments: ['BEGIN { printf "{\"r\": %.17g}\n", 3 * ARGV[1] + ARGV[2] % 1000 * 1e-5 }', "{{x}}", "{{small_seed}}"]
  inputs:
    x: {default: 0, least: -2, most: 2, doc: x}
    y: {default: 0, least: -2, most: 2, doc: y}
    z: {default: 0, least: -2, most: 2, doc: z}
  results:
    r: {doc: r}
YAML
python - <<'PY'
import random
random.seed(3)
with open("pairs.csv", "w") as f:
    print("x [1],y [1],z [1]", file=f)
    for i in range(100):
        x = -1 + 2 * (i + random.random()) / 100
        print(x, x + 0.3 * random.uniform(-1, 1), random.uniform(-1, 1), sep=",", file=f)
PY
printf '%s\n' 'name: pairs' 'scene: line.yaml' 'design: {file: pairs.csv}' 'seeds: 2' 'quantity: r' >pairs.yaml
expect 0 "$clast" run pairs.yaml --allow-commands --in-process -j 1 --quiet
expect 0 "$clast" sensitivity pairs.db -Q r
prints "y and x move together in these points: their effects cannot be told apart, and together may be the"
tr "\n" " " <out | grep -q "Of the other inputs: none can be told from one that does nothing: z alone" || fail "told without its pair"
ok "inputs that move together"

expect 64 "$clast" sensitivity ask.db sweep.yaml
says "are no design for sensitivity indices"
expect 64 "$clast" sensitivity sweep.yaml new.yaml --design grid
expect 64 "$clast" sensitivity sweep.yaml new.txt --design saltelli
expect 65 "$clast" sensitivity ask.yaml new.yaml --design saltelli
says "expected the key vary"
expect 66 "$clast" sensitivity none.db ask.yaml
[ ! -e new.yaml ] && [ ! -e new.csv ] || fail "a file of a refused design"
done_after 51
