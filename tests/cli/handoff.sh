#!/usr/bin/env bash
# clast handoff: fragments as CSV and for REBOUND, particles for miluphcuda. Small readers of those layouts, written for this
# test alone, compare them with the fields file: nothing is lost, and sums are those of the particles.
. "$(dirname "$0")/lib.bash"
export PYTHONPATH=$source/python CLAST=$clast PYTHONDONTWRITEBYTECODE=1

expect 0 "$clast" simulate basalt-sphere --set fidelity.particles=1500 --set stop.end_time='30 us' --fields sphere.hdf
expect 0 "$clast" simulate porous-ice --set fidelity.particles=1500 --set fidelity.projectile_spacing=0.3 --set stop.end_time='5 us' --fields ice.hdf
expect 0 "$clast" simulate disc-explosion --set body.diameter='8 cm' --set stop.end_time='1 ms' --fields disc.hdf
for target in sphere.csv sphere.txt sphere.h5; do
  expect 0 "$clast" handoff sphere.hdf $target
  says "$target written"
  case $target in
    *.h5) ! grep -q "in no fragment" err || fail "matter of the projectile is called missing" ;;
    *) says "kg in no fragment" ;;
  esac
  says "marked (!), 1 of 1 runs: coarse" # no mark has a place in these files
done
expect 0 "$clast" handoff ice.hdf ice.H5
expect 0 "$clast" handoff disc.hdf disc.csv

expect 0 python - <<'PY'
import csv, math
import clast

def close(a, b, what, tolerance=1e-12):
    assert abs(a - b) <= tolerance * max(abs(a), abs(b), 1e-300), (what, a, b)

def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))

# fragments of a body in space, against its particles
body = clast._read_hdf5("sphere.hdf")
data = {name: list(body["VTKHDF/PointData/" + name]) for name in ("mass", "density", "fragment")}
flat = [float(v) for row in body["VTKHDF/PointData/velocity"] for v in (row if hasattr(row, "__len__") else [row])]
velocity = [flat[3 * i:3 * i + 3] for i in range(len(data["mass"]))]
labelled = [i for i, label in enumerate(data["fragment"]) if label >= 0]
rows = table("sphere.csv")
assert len(rows) == int(body["outcome/fragment_count"][0]) and len(rows) > 100
assert list(rows[0]) == ["mass [kg]", "radius [m]", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]", "vz [m/s]",
                         "spin_x [rad/s]", "spin_y [rad/s]", "spin_z [rad/s]", "elements"]
close(sum(float(r["mass [kg]"]) for r in rows), sum(data["mass"][i] for i in labelled), "mass")
close(sum(4 / 3 * math.pi * float(r["radius [m]"]) ** 3 for r in rows),
      sum(data["mass"][i] / data["density"][i] for i in labelled), "volume")
assert sum(int(r["elements"]) for r in rows) == len(labelled)
scale = sum(data["mass"][i] * math.hypot(*velocity[i]) for i in labelled)
for axis in range(3):
    own = sum(data["mass"][i] * velocity[i][axis] for i in labelled)
    theirs = sum(float(r["mass [kg]"]) * float(r["v%s [m/s]" % "xyz"[axis]]) for r in rows)
    assert abs(own - theirs) <= 1e-12 * scale, (axis, own, theirs)
assert all((r["spin_x [rad/s]"] == "") == (int(r["elements"]) < 100) for r in rows)  # not known of few particles

# REBOUND: eight numbers a line, and nothing else
lines = open("sphere.txt").read().split("\n")
assert lines.pop() == "" and len(lines) == len(rows)
for line, row in zip(lines, rows):
    assert [float(x) for x in line.split()] == [float(row[k]) for k in list(row)[:8]], line

# miluphcuda
def same(mine, theirs, name, factor=lambda value: value):
    a, b = list(map(float, numbers(theirs))), [factor(float(v)) for v in numbers(mine)]
    assert len(a) == len(b) and all(x == y or abs(x - y) <= 1e-15 * abs(y) for x, y in zip(a, b)), name

def numbers(rows):
    return [v for row in rows for v in (row if hasattr(row, "__len__") else [row])]

for name, source in (("sphere.h5", body), ("ice.H5", clast._read_hdf5("ice.hdf"))):
    file, at = clast._read_hdf5(name), "VTKHDF/PointData/"
    same(source["VTKHDF/Points"], file["x"], "x")
    for theirs, ours in (("v", "velocity"), ("m", "mass"), ("rho", "density"), ("e", "energy"), ("material_type", "body"),
                         ("deviatoric_stress", "deviator")):
        same(source[at + ours], file[theirs], theirs)
    same(source[at + "pressure"], file["p"], "p", lambda value: 0.0 if math.isnan(value) else value)
    same(source[at + "smoothing_length"], file["sml"], "sml", lambda value: 2 * value)
    assert all(abs(float(a) ** 3 - float(b)) < 1e-14 for a, b in
               zip(file["DIM_root_of_damage_tensile"], source[at + "damage"])), "damage"
    assert float(file["time"][0]) > 0 and max(numbers(file["material_type"])) == 1
    assert ("alpha_jutzi" in file) == (name == "ice.H5")
same(source[at + "distention"], file["alpha_jutzi"], "distention")

# the plane: discs of the grains' area
body, rows = clast._read_hdf5("disc.hdf"), table("disc.csv")
assert list(rows[0]) == ["mass [kg/m]", "radius [m]", "x [m]", "y [m]", "vx [m/s]", "vy [m/s]", "spin [rad/s]", "elements"]
assert [float(r["mass [kg/m]"]) for r in rows] == list(map(float, body["fragments/mass"]))
for row in rows:
    close(math.pi * float(row["radius [m]"]) ** 2 * float(body["inputs/grain.density"][0]), float(row["mass [kg/m]"]), "area")
PY

# ---- refusals: nothing is written, and an older file stays
cp sphere.csv older.csv
expect 64 "$clast" handoff sphere.hdf picture.png
says "its ending must be .csv (fragments), .txt (fragments for REBOUND) or .h5"
expect 64 "$clast" handoff sphere.hdf
expect 66 "$clast" handoff none.hdf none.csv
expect 65 "$clast" handoff disc.hdf disc.txt
says "its body is in the plane, and its masses are per metre"
expect 65 "$clast" handoff disc.hdf disc.h5
says "has no particles: give a fields file of the engine sph"
head -c 3000 sphere.hdf >cut.hdf
expect 65 "$clast" handoff cut.hdf older.csv
expect 74 "$clast" handoff sphere.hdf none/fragments.csv
expect 74 "$clast" handoff sphere.hdf none/particles.h5
cmp -s sphere.csv older.csv || fail "a refused file replaced an older one"
same "$(ls | grep -c -e picture.png -e none.csv -e disc.txt -e disc.h5 -e unfinished)" 0 "files of refused commands"
done_after 18
