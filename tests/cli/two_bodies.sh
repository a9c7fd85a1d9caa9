#!/usr/bin/env bash
# The scenes of engine/sph/two-bodies.md run, with few particles and for a short time, and do what the page says.
. "$(dirname "$0")/lib.bash"
page=$source/engine/sph/two-bodies.md

awk '/^```/ { kind = substr($0, 4); file = ""; next }
  kind == "yaml" && !file && /^# .*\.yaml$/ { file = $2 }
  kind == "yaml" && file { print > file }' "$page"
same "$(ls ./*.yaml | xargs)" "./digger.yaml ./rod.yaml ./twins.yaml" "scenes of the page"
"$clast" materials basalt >my-rock.yaml
small=(--set fidelity.particles=400 --set stop.end_time='40 us' --json)
for scene in twins digger rod; do
  expect 0 "$clast" explain ./$scene.yaml
  mv out $scene.txt
  expect 0 "$clast" simulate ./$scene.yaml --set impact.gap='0.1 mm' "${small[@]}"
  mv out $scene.json
done
python - <<'PY' # each body has its own size, density and pores
import json, re
pi = 3.141592653589793
ball = lambda density, radius: density * 4 / 3 * pi * radius ** 3
want = {'twins': (ball(2700, 0.05), ball(2700, 0.05)),
        'digger': (2327 / 4.64 * pi * 0.1 ** 2 * 0.12, ball(917, 0.01)),
        'rod': (2680 * 0.12 * 0.12 * 0.03, 3000 * pi * 0.006 ** 2 * 0.04)}
for name, (target, projectile) in want.items():
    result, = json.load(open(name + '.json'))
    assert result['state'] in ('completed', 'end-time') and result['steps'] > 10, (name, result)
    assert abs(result['total_mass'] - target) < 1e-9 * target, (name, result['total_mass'], target)
    text = open(name + '.txt').read()
    said = float(re.search(r'^  projectile: .*?, ([0-9.e-]+) kg;', text, re.M).group(1))
    assert abs(said - projectile) < 1e-3 * projectile, (name, said, projectile)
    angle = {'twins': 45, 'digger': 30, 'rod': 20}[name]
    assert f'{angle} degrees from the normal' in text, text
PY
ok "masses of both bodies, and the angles"
printf 'name: pores\nscene: ./digger.yaml\nvary: {target.material.porosity.fraction: [20 %%, 50 %%, 78 %%]}\nseeds: {per_point: 1}\n' >pores.yaml
expect 65 "$clast" explain pumice-sphere --set target.material.porosity.fraction=80%
says "porosity.fraction is 0.8 (distention 5)"
expect 0 "$clast" plan pores.yaml --no-trial
prints "3 points"
done_after 10
