#!/usr/bin/env bash
# One run and the scenes: simulate, explain, scenes, cite, schema, picture.
. "$(dirname "$0")/lib.bash"

expect 0 "$clast" scenes --json
scenes=$(python -c "import json; print(*[s['name'] for s in json.load(open('out'))])")
same "$(echo "$scenes" | wc -w)" "$(ls "$source"/engine/*/scene/builtin/*.yaml | wc -l)" "built-in scenes"
for scene in $scenes; do
  expect 0 "$clast" scenes "$scene"
  cp out "./$scene.yaml"
  expect 0 "$clast" explain "./$scene.yaml"
  expect 0 "$clast" cite "$scene"
  grep -qE "Kun, |Benz & Asphaug|Gray" out || fail "$scene cites nobody"
done
expect 0 "$clast" cite basalt-sphere
! grep -qE "gradient_correction|artificial_stress" out || fail "what is off is cited"
same "$(grep -c "10.1006/icar.1994.1009" out)" 1 "rows of a paper"
prints "Benz & Asphaug 1994: Impact"; prints "weibull"; says "--all has the source of each input"
expect 0 "$clast" cite basalt-sphere --all
prints "10.1006/icar.1994.1009"; prints "target.material.weibull.m of"
expect 0 "$clast" cite basalt-sphere --bibtex
for key in benz1994 benz1995 benz1999 melosh1989 monaghan1992; do prints "{$key,"; done
! grep -q "kun1999\|monaghan2000" out || fail "BibTeX of papers that are not used"
expect 0 "$clast" cite basalt-sphere --set method.gradient_correction=true --all
prints "method.gradient_correction"
expect 66 "$clast" scenes disc-explosoin
says "disc-explosion"
expect 64 "$clast" scenes basalt-sphere@draft
says "clast scenes basalt-sphere"; ! grep -q "is a file" err || fail "a scene with settings is called a file"
expect 0 "$clast" explain beta
prints "ejecta.momentum_enhancement"
expect 0 "$clast" explain threshold.strain
prints "default"
expect 0 "$clast" explain contact
prints "contact.friction"
expect 65 "$clast" explain threshold.strian
says "threshold.strain"
expect 0 "$clast" explain --json
python -c "import json; assert len(json.load(open('out'))) > 60"
expect 0 "$clast" explain disc-explosion --set threshold.strain=5%
prints "0.05"
expect 0 "$clast" explain disc-explosion --set threshold.strain=5% --json # its inputs, for programs
python -c "
import json
rows = {r['path']: r for r in json.load(open('out'))}
assert rows['threshold.strain']['value'] == 0.05 and rows['threshold.angle']['unit'] == 'rad', rows
assert all(r['meaning'] for r in rows.values()) and len(rows) > 20, rows"
for text in "explain threshold.strain" "scenes disc-explosion" "materials basalt"; do # text whatever is asked for
  expect 64 "$clast" $text --json
  silent out
done

small=(--set "body.diameter=8 cm" --set "charge.energy=2 kJ/m" --set "stop.end_time=1 ms")
expect 0 "$clast" simulate disc-explosion --seed 7 "${small[@]}" --json
cp out first.json
expect 0 "$clast" simulate ./disc-explosion.yaml --seed 7 "${small[@]}" --json
cmp -s out first.json || fail "a built-in scene and its own document differ"
ok "the built-in scene and its document give the same bits"
expect 0 "$clast" simulate ./disc-explosion.yaml --seed 7 "${small[@]}"
tr '\n' ' ' <out | grep -qF '`clast converge ./disc-explosion.yaml --set ' || fail "the study of another scene is offered"
expect 0 "$clast" simulate disc-explosion --seed 8 "${small[@]}" --json
if cmp -s out first.json; then fail "another seed gives the same result"; fi
expect 0 "$clast" simulate disc-explosion --seed 7 "${small[@]}" --fields end.h5 --snapshots 3 --picture end.png
prints "M_1/M"; prints "beta"
for file in end.h5 disc-explosion_000000.hdf disc-explosion_000002.hdf; do [ -s "$file" ] || fail "no $file"; done
[ ! -e disc-explosion_000003.hdf ] || fail "too many snapshots"
python - <<'PY'
import json
series = json.load(open('disc-explosion.hdf.series'))['files']
assert [f['name'] for f in series] == ['disc-explosion_%06d.hdf' % k for k in range(3)], series
assert 0 == series[0]['time'] < series[1]['time'] < series[2]['time'] and abs(series[2]['time'] - 1e-3) < 1e-5, series
data = open('end.png', 'rb').read()
assert data[:8] == b'\x89PNG\r\n\x1a\n' and len(data) > 5000, len(data)
PY
ok "snapshots, fields and picture"
expect 0 "$clast" picture disc-explosion_000001.hdf middle.png
silent err # what only the end tells is no doubt before it
expect 0 "$clast" picture disc-explosion_000002.hdf middle.png
says "marked (!), 1 of 1 runs: cut"
expect 0 "$clast" simulate disc-explosion --seed 7 "${small[@]:2:2}" --set body.diameter='6 cm' --snapshots 5 -q
says "3 of 5 snapshots written" # also with -q
# The time that is offered lies after the end, 1.2754 ms here: a rounded one before it would cut the run.
quiet=("${small[@]:2:2}" --set body.diameter='6 cm' --set stop.least_time='1 ms' --set fidelity.time_step='0.2 us')
expect 0 "$clast" simulate disc-explosion --seed 7 "${quiet[@]}" --snapshots 5
end=$(tr '\n' ' ' <err | sed -n "s/.*--set stop.end_time='\([^']*\)'.*/\1/p")
same "$end" "0.001276 s" "the time that gives all snapshots"
expect 0 "$clast" simulate disc-explosion --seed 7 "${quiet[@]}" --set stop.end_time="$end" --snapshots 5
[ -e disc-explosion_000004.hdf ] && ! grep -qE "snapshots written|still broke|cut" err || fail "the time of the end does not give all snapshots"
ok "a snapshot before the end is not judged as an end"
sleep 1 # HDF5 knows seconds
expect 0 "$clast" simulate disc-explosion --seed 7 "${small[@]}" --fields later.h5 --snapshots 1
says "4 snapshots of an earlier run lie beside these, from disc-explosion_000001.hdf on"
cmp -s end.h5 later.h5 || fail "the fields of the same run differ from one second to the next"
cmp -s end.h5 disc-explosion_000000.hdf || fail "a single snapshot is not one of the end"
time=$(python -c "import h5py; print('%.4g' % (1e3 * float(h5py.File('end.h5')['run'].attrs['time'])))") # s
expect 0 "$clast" picture end.h5 again.png --caption "disc-explosion: seed 7, $time ms"
cmp -s end.png again.png || fail "the picture of the same fields differs"
expect 66 "$clast" picture missing.h5 x.png
head -c 5000 /dev/urandom >noise.h5
expect 65 "$clast" picture noise.h5 x.png
expect 74 "$clast" simulate disc-explosion "${small[@]}" --fields none/such/folder/end.h5
one_error

for what in scene campaign; do
  expect 0 "$clast" schema $what
  python -c "import json, jsonschema; jsonschema.Draft7Validator.check_schema(json.load(open('out')))"
done
expect 64 "$clast" schema elephant

# Every key and every fixed word of a campaign document has its explanation.
expect 0 "$clast" schema campaign
words=$(python - <<'PY'
import json
def walk(node, path, words):
    if isinstance(node, list):
        for item in node: walk(item, path, words)
    elif isinstance(node, dict):
        for key, item in node.get('properties', {}).items():
            here = key if path == 'vary' else f'{path}.{key}'.lstrip('.')
            words.add(here)
            walk(item, 'vary' if path == 'vary' else here, words)
        for word in node.get('enum', []): words.add(word)
        for key in ('anyOf', 'items', 'additionalProperties'): walk(node.get(key), path, words)
words = set()
walk(json.load(open('out')), '', words)
assert {'vary', 'set', 'design.points', 'keep.fields', 'lognormal', 'sobol', 'seeds.until.batch'} <= words, words
print(*sorted(words))
PY
)
for word in $words; do
  "$clast" explain "$word" >out 2>err || fail "\`clast explain $word\` has no answer"
done
ok "clast explain answers for $(echo "$words" | wc -w) words of a campaign"
expect 0 "$clast" explain vary
prints "log_uniform"
expect 65 "$clast" explain desing
says "design"
# The scene's own result stands first, and its line says what it is.
expect 0 "$clast" simulate elastic-bar --set stop.end_time=0.1us
sed -n 2p out | grep -qE '^frequency .* 1/s; frequency of the first mode' || fail "no line of the frequency"
expect 0 "$clast" simulate porous-plate --set piston.speed='200 m/s' --set fidelity.points=100 # beside the exact values
for row in shock.pressure shock.speed precursor.speed precursor.pressure; do
  grep -qE "^$row +[0-9.×^]+ +(Pa|m/s); exact: [0-9.×^]+; " out || fail "no exact $row"
done
expect 0 "$clast" simulate uniaxial --set body.rows=6 --set body.columns=4 # a marked number of four digits
grep -qE '^young_modulus +[0-9.×^]+ ! Pa' out || fail "no blank before the unit"
# What the inputs alone forbid is refused before a run; a run that could not begin has no numbers.
expect 1 "$clast" simulate gabbro-crater --seed 1 --set fidelity.graded=false --set fidelity.particles=3000 \
  --set fidelity.projectile_spacing=0.1 --set sides.far=damped --set sides.depth='0.1 mm'
prints "no results"; ! grep -q "M_1/M" out || fail "numbers of a run that did not begin"
expect 65 "$clast" explain gabbro-crater --set fidelity.particles=3000
says "particles, not 3000: give fidelity.particles within this range"
expect 0 "$clast" explain gabbro-crater --set fidelity.particles="$(tr '\n' ' ' <err | sed 's/.*gives \([0-9]*\) to.*/\1/')" # one remedy is enough
expect 65 "$clast" explain gabbro-crater --set fidelity.graded=false --set fidelity.particles=3000
expect 0 "$clast" explain gabbro-crater --set fidelity.graded=false --set fidelity.particles=3000 \
  --set fidelity.projectile_spacing="$(tr '\n' ' ' <err | sed 's/.* to \([0-9.]*\), raise.*/\1/')"
expect 0 "$clast" explain solid-ice --set fidelity.spacings_per_radius=2
tr '\n' ' ' <out | grep -q "; spacings_per_radius itself is below 5 (clast" || fail "a number of particles that does not cure"
# A box of which one side is given.
printf 'engine: sph\nname: cube\ntarget: {shape: box, width: 5 cm, material: basalt}\nimpact: {projectile: mass, mass: 0.2 g, speed: 3 km/s}\n' >cube.yaml
expect 0 "$clast" explain ./cube.yaml
tr '\n' ' ' <out | grep -qF "of a box, target.width is given, and the other sides have their defaults: target.depth 0.2 m, target.height 0.2 m" ||
  fail "the other sides are not told"
done_after $((55 + 3 * $(echo "$scenes" | wc -w)))
