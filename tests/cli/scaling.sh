#!/usr/bin/env bash
# `clast scaling` over stores of discs: small ones as they break, and the same store with masses of a known law.
. "$(dirname "$0")/lib.bash"

cat >discs.yaml <<'YAML'
name: discs
scene: disc-collision
vary:
  body.diameter: [6 cm, 9 cm, 13.5 cm, 20 cm]
  collision.speed: [10 m/s, 14 m/s, 17 m/s, 20 m/s, 24 m/s, 30 m/s, 40 m/s]
  stop.end_time: {linked: body.diameter, factor: 0.01}
set: {stop.least_time: 0 s}
seeds: {per_point: 3}
store: discs.db
YAML
expect 0 "$clast" run discs.yaml -j 2 --quiet
expect 0 "$clast" scaling discs.db
says "marked (!), $(number discs.db "select sum(warnings like '%cut%') || ' of ' || count(*) from runs") runs: cut"
grep -qE '^(No crossing|Not one curve|Too few)' out || fail "an exponent from three seeds of tiny discs"
says "84 runs, sizes by diameter"

# Masses that obey a law with known exponents (test_scaling_fit.c): the largest fragment, one half of the others equal.
cat >law.py <<'PY'
import random, sqlite3, struct, sys
critical, nu, beta, gamma = 20.0, 1.0, 0.2, 1.6
db = sqlite3.connect(sys.argv[1])
runs = db.execute("SELECT run_id, seed, body_diameter, collision_speed, total_mass, (SELECT max(lower) / 10 FROM estimate e "
                  "WHERE e.run_id = runs.run_id AND method = 'masses' AND window = 'from_10') FROM runs").fetchall()
for run, seed, diameter, speed, mass, element in runs:
    rng = random.Random(1000 * seed + round(1000 * diameter))
    length = (mass / element) ** 0.5
    z = -(speed - critical) / critical * length ** (1 / nu)
    p = 0.6 * length ** -beta * pow(2.718281828, 0.1 * z + 0.05 * rng.gauss(0, 1))
    p = min(p, 0.95)
    s = 0.05 * length ** gamma * pow(2.718281828, -0.1 * z + 0.05 * rng.gauss(0, 1)) / length ** 2  # sum of squared shares
    n = max(1, round((1 - p) ** 2 / s))  # equal fragments; the largest has p
    masses = sorted([p * mass] + [(1 - p) * mass / n] * n, reverse=True)
    db.execute("UPDATE fragment_mass SET masses = ? WHERE run_id = ?", (struct.pack("<%dd" % len(masses), *masses), run))
    db.execute("UPDATE run SET largest_fraction = ? WHERE run_id = ?", (masses[0] / mass, run))
db.commit()
PY
cp discs.db law.db
python law.py law.db
expect 0 "$clast" scaling law.db
tr '\n' ' ' <out | grep -q '^Critical speed: .* m/s .*nu .*beta/nu .*gamma/nu .*D .*tau ' || fail "the answer"
grep -Eq 'm/s !' out && grep -Eq '^nu .* !( |$)' out || fail "no mark"
expect 0 "$clast" scaling law.db --json
python - <<'PY'
import json
rows = {r["name"]: r for r in json.load(open("out"))}
assert list(rows)[:6] == ["critical", "nu", "beta/nu", "gamma/nu", "D", "tau"], rows
for name, exact in {"critical": 20, "nu": 1, "beta/nu": 0.2, "gamma/nu": 1.6}.items():
    r = rows[name]
    assert r["answer"] == "found" and abs(r["value"] - exact) <= r["value_hw95"] < exact, r
PY
ok "known exponents"
expect 0 "$clast" scaling law.db --size diameter --control speed -Q largest_fraction --csv
same "$(head -1 out)" "name,value,value_hw95,shift,meaning,answer,doubtful,doubts" "columns"
if command -v gnuplot >/dev/null; then
  expect 0 "$clast" scaling law.db --picture collapse.svg --keep-script
  grep -q 'diameter\|elements' collapse.svg && grep -q '! in doubt' collapse.gp || fail "the picture"
else
  ok "no gnuplot"
fi

# Fewer sizes, a control that is none, and what is refused.
expect 0 "$clast" scaling law.db --where "body_diameter < 0.1" --csv
grep -q 'too-few' out || fail "two sizes"
expect 64 "$clast" scaling law.db --control strain
expect 64 "$clast" scaling law.db --where "collision_speed = 10"
says "no input varies at a size"
expect 64 "$clast" scaling law.db --size speed
says "speed does not set the number of grains or particles; diameter does"
expect 64 "$clast" scaling law.db --dimensions 3
says "expects a whole number that is 2"
expect 0 "$clast" scaling law.db --where "collision_speed > 20"
grep -q '^No crossing: from 24 to 40 m/s' out && grep -q 'Next: ' out || fail "no next step"
! grep -qi 'nan' out || fail "NaN"
cat >single.yaml <<'YAML'
name: single
scene: disc-explosion
set: {body.diameter: 8 cm, stop.end_time: 0.1 ms}
vary: {threshold.strain: [2 %, 4 %]}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run single.yaml --quiet
expect 64 "$clast" scaling single.db
says "scaling needs two varied inputs, a size and a control"

# Percolation by a program of one's own: its scene does not tell that the lattice is plane.
cat >percolation.py <<'PY'
import json, random, sys

side, p = int(sys.argv[1]), float(sys.argv[2])
rng = random.Random(int(sys.argv[3]))
full = [rng.random() < p for _ in range(side * side)]
root = list(range(side * side))

def find(i):
    while root[i] != i:
        root[i] = i = root[root[i]]
    return i

for y in range(side):
    for x in range(side):
        for other in (y * side + (x + 1) % side, (y + 1) % side * side + x):
            if full[y * side + x] and full[other]:
                root[find(other)] = find(y * side + x)
sites = {}
for i in range(side * side):
    if full[i]:
        sites[find(i)] = sites.get(find(i), 0) + 1
print(json.dumps({"clusters": len(sites), "masses": list(sites.values())}))
PY
cat >percolation.yaml <<'YAML'
engine: command
name: percolation
command:
  program: python3
  version: "1"
  arguments: [-S, -E, percolation.py, "{{side}}", "{{p}}", "{{seed}}"]
  files: [percolation.py]
  inputs:
    side: {kind: count, default: 16, least: 2, most: 1000, resolution: larger, doc: Side of the square lattice.}
    p: {default: 0.6, least: 0, most: 1, doc: Share of the sites that are occupied.}
  results:
    clusters: {doc: Number of clusters.}
  fragments: {name: masses, element_mass: 1 kg}
YAML
cat >sides.yaml <<'YAML'
name: sides
scene: percolation.yaml
vary:
  side: [6, 9, 14, 20]
  p: [0.52, 0.56, 0.59, 0.62, 0.66]
seeds: {per_point: 2}
store: sides.db
YAML
expect 0 "$clast" run sides.yaml --allow-commands --quiet
expect 64 "$clast" scaling sides.db
says "whether the model of this store's program is plane: if it is, add --dimensions 2"
expect 64 "$clast" scaling sides.db --dimensions 3
says "expects a whole number that is 2"
expect 0 "$clast" scaling sides.db --dimensions 2
says "40 runs, sizes by side; L is the number of grains or particles to the power 1/2"
expect 0 "$clast" scaling sides.db --dimensions 2 --csv
grep -q '^critical,.*\(found\|not-told\|no-crossing\|not-one-curve\)' out || fail "the answer of percolation"
done_after 21
