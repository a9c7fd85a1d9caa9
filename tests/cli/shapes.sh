#!/usr/bin/env bash
# A target from a shape file, from the scene to the store: the run depends on what the file holds and not on its name,
# and the store needs the file no more.
. "$(dirname "$0")/lib.bash"

sql() { python -c 'import sqlite3, sys
db = sqlite3.connect(sys.argv[1])
for row in db.execute(sys.argv[2]): print("|".join(str(x) for x in row))
db.commit()' "$@"; }

# The example of the page, with few particles, and the same surface as binary STL.
mkdir scenes
awk '/^```/ { file = /^```python/ ? "scenes/lobes.py" : ""; first = /^```yaml/; next }
  first { file = "scenes/" $2; first = 0 }
  file { print > file }' "$source/engine/sph/shape-files.md"
same "$(ls scenes | xargs)" "lobes.py lobes.yaml" "files of the page"
(cd scenes && python lobes.py)
sed -i 's/particles: 20000/particles: 600/; s/60 us/20 us/' scenes/lobes.yaml
python - <<'PY'
import struct
vertices, triangles = [], []
for line in open('scenes/lobes.obj'):
    word, *rest = line.split()
    if word == 'v':
        vertices.append([struct.unpack('f', struct.pack('f', float(x)))[0] for x in rest])
    else:
        corners = [vertices[int(c)] for c in rest]
        triangles += [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]
with open('scenes/lobes.stl', 'wb') as out:
    out.write(bytes(80) + struct.pack('<I', len(triangles)))
    for t in triangles:
        out.write(struct.pack('<12fH', 0, 0, 0, *[x for p in t for x in p], 0))
open('scenes/open.obj', 'w').write(open('scenes/lobes.obj').read().rsplit('v ', 4)[0])
det = lambda a, b, c: sum(a[i] * (b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2]) for i in range(3))
print('%.17g' % (2700 * 0.03 ** 3 * abs(sum(det(*t) for t in triangles)) / 6), file=open('mass', 'w'))
PY
cat >lobes.yaml <<'YAML'
name: lobes
scene: ./scenes/lobes.yaml
vary: {impact.speed: [1 km/s, 2 km/s]}
seeds: {per_point: 2}
YAML

expect 0 "$clast" explain ./scenes/lobes.yaml
prints "mesh of 1472 faces, 0.108 x 0.03847 x 0.03847 m"
expect 0 "$clast" simulate ./scenes/lobes.yaml --picture lobes.png --json
mv out one.json
expect 0 test -s lobes.png
expect 0 "$clast" run lobes.yaml --store lobes.db --slots 2
same "$(sql lobes.db "SELECT count(*), count(DISTINCT digest) FROM run")" "4|4" "runs"
hash=$(sha256sum scenes/lobes.obj)
same "$(sql lobes.db "SELECT hash, length(bytes) FROM shape_file")" "${hash%% *}|$(stat -c %s scenes/lobes.obj)" "file in the store"
same "$(sql lobes.db "SELECT DISTINCT value FROM point_input WHERE path = 'target.mesh.file'")" "${hash%% *}" "input"

# Another name is the same run; other bytes are other ones.
identities() { sql "$1" "SELECT hex(identity) FROM run ORDER BY 1"; }
sed 's/lobes.obj/renamed.obj/' scenes/lobes.yaml >scenes/renamed.yaml
cp scenes/lobes.obj scenes/renamed.obj
sed 's/lobes.yaml/renamed.yaml/' lobes.yaml >renamed.yaml
expect 0 "$clast" run renamed.yaml --store renamed.db --slots 2
same "$(identities renamed.db)" "$(identities lobes.db)" "identities of another name"
expect 0 "$clast" simulate ./scenes/lobes.yaml --set target.mesh.file=scenes/lobes.stl --json
python - <<'PY' # the same surface within the digits of a float
import json
one, two = (json.load(open(name))[0]['total_mass'] for name in ('one.json', 'out'))
mass = float(open('mass').read())
assert abs(one / two - 1) < 1e-6 and abs(one / mass - 1) < 1e-6, (one, two, mass)
PY
ok "OBJ and STL"

# Bytes behind the last triangle change nothing, and a note tells of them; a shorter file is refused.
{ cat scenes/lobes.stl; printf '\0made by a program'; } >scenes/tail.stl
head -c -1 scenes/lobes.stl >scenes/short.stl
expect 0 "$clast" simulate ./scenes/lobes.yaml --set target.mesh.file=scenes/tail.stl --json
says "warning: tail: the number of bytes in the shape file behind its last triangle is 18, above 0"
prints 'tail, cut, shallow' # the crater of so few particles is 1.7 spacings deep
expect 64 "$clast" simulate ./scenes/lobes.yaml --set target.mesh.file=scenes/short.stl
says "cut short"

# Three cubes in one file are three pieces from the start: `links` marks them only if one of them counts as many.
python - <<'PY'
with open('scenes/cubes.obj', 'w') as out:
    for body, middle in enumerate((0, -2, 2)):
        out.writelines(f'v {middle + x} {y} {z}\n' for x in (-.5, .5) for y in (-.5, .5) for z in (-.5, .5))
        for face in (1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4):
            out.write('f ' + ' '.join(str(8 * body + corner) for corner in face) + '\n')
PY
for length in 1.2 0.6; do
  expect 0 "$clast" simulate ./scenes/lobes.yaml --set target.mesh.file=scenes/cubes.obj --set target.fracture=off \
    --set stop.end_time='6 us' --set fragments.link_length=$length --json
  python - $length <<'PY'
import json, sys
run, short = json.load(open('out'))[0], float(sys.argv[1]) < 1
assert ('links' in run['warnings']) == short, run['warnings']
assert (run['fragment_count'] == 3) == (not short), run['fragment_count']
PY
done
ok "three parts"

# A ball bounces off a whole cube, obliquely, on a face that is not level: its momentum enhancement is the momentum that
# the cube has over that of the ball, both along the normal.
python - <<'PY'
import math
c, s = math.cos(0.4), math.sin(0.4)
with open('scenes/tilted.obj', 'w') as out:
    cube = [(x, y, z) for x in (-.5, .5) for y in (-.5, .5) for z in (-.5, .5)]
    out.writelines(f'v {c * x - s * z:.15g} {y} {s * x + c * z:.15g}\n' for x, y, z in cube)
    for face in (1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4):
        out.write('f ' + ' '.join(map(str, face)) + '\n')
PY
cat >scenes/tilted.yaml <<'YAML'
engine: sph
name: tilted
kind: impact
target: {shape: mesh, mesh: {file: ./tilted.obj, unit: 6 cm}, fracture: off, material: {name: basalt, yield_stress: off}}
projectile: {radius: 2 cm, fracture: off, material: {name: basalt, yield_stress: off}}
impact: {speed: 30 m/s, angle: 30 deg}
method: {contact: overlap}
fidelity: {particles: 2500, projectile_spacing: 1}
stop: {end_time: 300 us}
YAML
expect 0 "$clast" simulate ./scenes/tilted.yaml --fields tilted.hdf --json
mv out tilted.json
PYTHONPATH=$source/python PYTHONDONTWRITEBYTECODE=1 python - <<'PY'
import clast, json, math
run, body = json.load(open('tilted.json'))[0], clast._read_hdf5('tilted.hdf')
(mass,), velocity = body['fragments/mass'], body['fragments/velocity']
x, _, z = velocity if len(velocity) == 3 else velocity[0] # numpy gives rows
gained = mass * (math.cos(0.4) * z - math.sin(0.4) * x)
brought = -run['projectile_mass'] * 30 * math.cos(math.pi / 6)
found = run['ejecta_momentum_enhancement']
assert found > 1.2 and abs(found * brought / gained - 1) < 1e-3, (found, gained / brought)  # momentum is kept to 1e-13
PY
ok "a face that is not level"
# A cube that turns about z moves matter along that normal.
spin() { expect 0 "$clast" simulate ./scenes/tilted.yaml --set method.gradient_correction=true --set stop.end_time='5 us' \
  --set impact.gap='0.1 mm' --set target.spin="$1"; }
expect 0 "$clast" explain basalt-sphere --set target.spin='1000 rad/s' --set method.gradient_correction=true
! grep -q "tilt" out err || fail "a sphere that turns has a mark of a tilted face"
spin '1000 rad/s' # 30 m/s at an edge, of which sin(0.4) is along the normal
says "warning: tilt: the speed at which the target's rotation moves its surface"
spin '800 rad/s'
! grep -q tilt err || fail "tilt at 800 rad/s"

sed 's/lobes.obj/open.obj/' scenes/lobes.yaml >scenes/open.yaml
expect 65 "$clast" simulate ./scenes/open.yaml
says "scenes/open.yaml:5"
says "the surface is open"
expect 66 "$clast" simulate ./scenes/lobes.yaml --set target.mesh.file=no-such.obj
says "cannot read the shape file 'no-such.obj'"
sed 's/impact.speed:.*/target.mesh.file: [a.obj, b.obj]}/' lobes.yaml >vary.yaml
expect 65 "$clast" plan vary.yaml
says "a shape file cannot be varied"

# Ranks get the file with their runs.
bits lobes.db >lobes.bits
expect 0 mpirun -n 3 "$clast" run lobes.yaml --store ranks.db
same_bits ranks.db lobes.bits "three ranks"

# The store alone is enough: replay, check and merge.
rm -r scenes renamed.yaml
expect 0 "$clast" replay lobes.db 3
says "agree to the last bit"
expect 0 "$clast" check lobes.db
cp lobes.db damaged.db
expect 0 "$clast" merge all.db lobes.db renamed.db
same "$(sql all.db "SELECT count(*) FROM shape_file")" 1 "files after a merge"
expect 0 "$clast" replay all.db 1
sql damaged.db "UPDATE shape_file SET bytes = CAST(replace(bytes, 'v 1.9', 'v 1.8') AS BLOB)"
expect 65 "$clast" replay damaged.db 1
says "have changed since it was stored"
expect 65 "$clast" check damaged.db
prints "have changed since it was stored"

done_after 34
