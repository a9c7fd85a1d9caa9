#!/usr/bin/env bash
# Twins with the engines (fit_twins.md): inputs drawn from the priors, one specimen computed with them and a seed of its own,
# and `clast fit` on what it shows. CLAST_FULL=1: 200 discs and 20 spheres (CLAST_SEEDS=n: n of each); quick form: 2 discs.
set -euo pipefail
clast=$(realpath "$1")/clast
work=$(mktemp -d "$1/fit-engines-XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
/usr/bin/python3 - "$clast" "${CLAST_SEEDS:-0}" "${CLAST_FULL:-}${CLAST_SEEDS:-}" <<'PY'
import json, math, os, random, subprocess, sys

clast, asked, full = sys.argv[1], int(sys.argv[2]), bool(sys.argv[3])

WHOLE = {"dem": 200, "sph": 20}  # cases of the full form

# Of each engine: scene, what is set, unknown inputs with the law, its ends and the unit, what is measured with its error.
ENGINES = {
    "dem": ("disc-explosion", {"body.diameter": "6 cm", "charge.energy": "2 kJ/m", "stop.end_time": "0.5 ms"},
            {"threshold.strain": ("log_uniform", 1, 8, " %"), "threshold.angle": ("uniform", 1, 8, " deg")},
            {"largest_fraction": 0.01, "dust_fraction": 0.01}),
    "sph": ("basalt-sphere", {"fidelity.particles": "400", "fidelity.cfl": "0.4", "target.material.weibull.m": "8.5"},
            {"target.material.weibull.k": ("log_uniform", 1e32, 1e38, " 1/m^3")}, {"largest_fraction": 0.01}),
}


def run(*words):
    done = subprocess.run([clast, *words], capture_output=True, text=True)
    assert done.returncode == 0, (words, done.stderr)
    return done.stdout


def case(engine, number):
    """True when the 90 % interval of an input holds it, for every input."""
    scene, fixed, unknown, measured = ENGINES[engine]
    draw = random.Random(f"{engine} {number}")
    truth = {}
    for path, (law, low, high, unit) in unknown.items():
        truth[path] = draw.uniform(low, high) if law == "uniform" else math.exp(draw.uniform(math.log(low), math.log(high)))
    name = f"{engine}{number}"
    setting = ", ".join(f"{path}: {value}" for path, value in fixed.items())
    with open(f"{name}-truth.yaml", "w") as out:
        known = ", ".join(f"{path}: {truth[path]:.9g}{unknown[path][3]}" for path in truth)
        out.write(f"name: truth\nscene: {scene}\nset: {{{setting}, {known}}}\n"
                  f"seeds: {{first: {100000 + number}, per_point: 1}}\nstore: {name}-truth.db\n")
    run("run", f"{name}-truth.yaml", "--quiet", "-j", "1", "--in-process")
    columns = ", ".join(measured)
    row = json.loads(run("query", f"{name}-truth.db", f"select {columns} from runs", "--json"))[0]
    with open(f"{name}-measured.yaml", "w") as out:
        out.write("name: twin\nsource: a run of the program\nshots:\n  - measured:\n")
        for quantity, error in measured.items():
            value = min(max(row[quantity] + draw.gauss(0, error), 0), 1)  # a share, as a laboratory would give it
            out.write(f"      - {{quantity: {quantity}, value: {value}, error: {error}, resolution: 0}}\n")
    with open(f"{name}.yaml", "w") as out:
        laws = "".join(f"  {path}: {{{law}: [{low}{unit}, {high}{unit}]}}\n" for path, (law, low, high, unit) in unknown.items())
        out.write(f"name: {name}\nscene: {scene}\nset: {{{setting}}}\nvary:\n{laws}"
                  f"design: {{kind: latin_hypercube, points: 12, seed: {number + 1}}}\nseeds: {{per_point: 3}}\nstore: {name}.db\n")
    rows = json.loads(run("fit", f"{name}-measured.yaml", f"{name}.yaml", "--rounds", "5", "--json", "--quiet", "-j", "1", "--in-process"))
    os.remove(f"{name}.db")
    held = {}
    for row in rows:
        if row["kind"] == "input":
            factor = {" deg": math.pi / 180, " %": 0.01}.get(unknown[row["name"]][3], 1)
            held[row["name"]] = (row["q05"] <= truth[row["name"]] * factor <= row["q95"], row["kept"])
    return held


good = True
for engine in ENGINES if full else ["dem"]:
    cases = asked or (WHOLE[engine] if full else 2)
    results = [case(engine, number) for number in range(cases)]
    for path in results[0]:
        held = sum(r[path][0] for r in results)
        kept = sum(r[path][1] for r in results) / cases
        print(f"{engine} {path}: held in {held} of {cases}, interval {kept:.2f} of the prior's", flush=True)
        good &= 0.85 * cases <= held <= 0.95 * cases if cases >= 100 else held >= 0.5 * cases
sys.exit(not good)
PY
