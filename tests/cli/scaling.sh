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
says "marked (!), "
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
says "several inputs vary at a size: --control names one of diameter, "
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
done_after 14
