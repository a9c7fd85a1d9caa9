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

expect 0 "$clast" sensitivity sweep.yaml morris.yaml --design morris --blocks 4
same "$(grep -c . morris.csv)" 13 "lines of the trajectories"
expect 0 "$clast" run morris.yaml --store ask.db -j 2 --quiet
expect 0 "$clast" sensitivity ask.db morris.yaml --json
python -c "
import json; rows = json.load(open('out'))
assert [r['input'] for r in rows] == ['threshold.strain', 'threshold.angle']
assert all(r['mean_absolute'] >= abs(r['mean']) >= 0 and r['noise'] > 0 for r in rows), rows"
ok "elementary effects"

expect 64 "$clast" sensitivity ask.db sweep.yaml
says "are no design for sensitivity indices"
expect 64 "$clast" sensitivity sweep.yaml new.yaml --design grid
expect 64 "$clast" sensitivity sweep.yaml new.txt --design morris
expect 65 "$clast" sensitivity ask.yaml new.yaml --design morris
says "expected the key vary"
expect 66 "$clast" sensitivity none.db ask.yaml
[ ! -e new.yaml ] && [ ! -e new.csv ] || fail "a file of a refused design"
done_after 23
