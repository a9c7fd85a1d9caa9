#!/usr/bin/env bash
# `clast materials`: the built-in materials of engine sph.
. "$(dirname "$0")/lib.bash"

expect 0 "$clast" materials --json
python -c "
import json
rows = {r['name']: r for r in json.load(open('out'))}
assert len(rows) >= 10, rows.keys()
assert rows['basalt']['density'] == 2700 and rows['basalt']['weibull_m'] == 8.5, rows['basalt']
assert rows['nylon']['weibull_k'] is None
"
for material in basalt nylon ice gabbro steel aluminium polycarbonate granite pumice rubber; do
  expect 0 "$clast" materials $material
  prints "source:"
  prints "material: $material"
done
expect 66 "$clast" materials basalr
says "did you mean 'basalt'"
expect 64 "$clast" materials basalt ice
says "does not know what to do"

# Every printed document can be used as a file: it gives the same run as the material's name.
scene() { printf 'engine: sph\nkind: impact\ntarget: {radius: 3 cm, material: %s}\nprojectile: {radius: 6 mm}\nfidelity: {particles: 200}\nimpact: {gap: 0.1 mm}\nstop: {end_time: 1 us}\n' "$1"; }
inputs() { "$clast" explain "$1" --json | python -c "
import json, sys; print(*[(r['path'], r['value']) for r in json.load(sys.stdin) if r['path'] != 'target.material.name'], sep='\n')"; }
for material in $("$clast" materials --csv | tail -n +2 | cut -d, -f1); do
  "$clast" materials "$material" >"$material.yaml"
  grep -q "^sources:" "$material.yaml" || fail "$material has no source for each value"
  "$clast" materials "./$material.yaml" | cmp -s - "$material.yaml" || fail "$material: its own document is refused"
  scene "$material" >named.yaml
  scene "./$material.yaml" >filed.yaml
  inputs named.yaml >named.inputs && inputs filed.yaml >filed.inputs || fail "inputs of $material"
  [ "$(wc -l <named.inputs)" -gt 40 ] && cmp -s named.inputs filed.inputs || fail "$material: its file makes other inputs"
done
ok "each document can be fed back"

# The store keeps the values: a run replays without the file.
mkdir deep
"$clast" materials basalt-nakamura | sed 's/m: 16/m: 15.5/' >deep/rock.yaml
scene ./rock.yaml >deep/s.yaml
printf 'name: own\nscene: deep/s.yaml\nseeds: {per_point: 1}\n' >own.yaml
expect 0 "$clast" run own.yaml --quiet
rm -r deep
expect 0 "$clast" replay own.db 1
same "$(sqlite3 own.db "select value from point_input where path = 'target.material.weibull.m'")" 15.5 "a value of the file in the store"

# Incomplete and wrong files are refused, with their place.
sed '/^yield_stress/d' basalt.yaml >short.yaml
scene short.yaml >s.yaml
expect 65 "$clast" simulate s.yaml
says "target.material 'short.yaml' lacks yield_stress (or off): give"
sed '/^yield_stress/d; /^melt_energy/d' basalt.yaml >short.yaml # all that is missing at once
expect 65 "$clast" simulate s.yaml
says "lacks melt_energy (or off), yield_stress (or off): give"
sed 's/^density: .*/density: -3 kg/' basalt.yaml >wrong.yaml
scene wrong.yaml >s.yaml
expect 65 "$clast" explain ./s.yaml
says "wrong.yaml:"; one_error
expect 65 "$clast" materials ./wrong.yaml
sed 's/^  weibull:/  weibul:/' basalt.yaml >wrong.yaml
expect 65 "$clast" materials ./wrong.yaml
says "'weibul' is no value"
scene ./none.yaml >s.yaml
expect 65 "$clast" explain ./s.yaml
says "none.yaml: there is no such file"; one_error
scene "{file: basalt.yaml, density: 2.8 g/cm^3}" >s.yaml
expect 0 "$clast" explain ./s.yaml
prints "2800 kg/m^3"
scene "{name: ./basalt.yaml}" >s.yaml
expect 0 "$clast" explain ./s.yaml
prints "of basalt.yaml"

# A file everywhere that a name is; a rock like another; the later layer wins whole.
mkdir rocks
sed 's/^density: .*/density: 2.75 g\/cm^3/' granite.yaml >rocks/own.yaml
printf 'material: thin\nlike: basalt\ndensity: 2.2 g/cm^3\n' >rocks/thin.yaml
expect 0 "$clast" materials rocks/thin.yaml
sed 's/like: .*/like: basald/' rocks/thin.yaml >wrong.yaml
expect 65 "$clast" materials ./wrong.yaml
says "wrong.yaml:2:7: error: like: there is no material 'basald'; did you mean 'basalt'?"
sed 's/like: .*/like: .\/thin.yaml/' rocks/thin.yaml >wrong.yaml
scene ./wrong.yaml >s.yaml
expect 65 "$clast" explain ./s.yaml
says "wrong.yaml:2:7: error: like: only built-in materials can be named here, no files"; one_error
sed 's/^material:/name:/' rocks/thin.yaml >wrong.yaml
expect 65 "$clast" explain ./s.yaml
says "wrong.yaml:1:1: error: name: unknown key; known here are density,"; says "weibull, sources, material, source, like"; one_error
scene rocks/own.yaml >s.yaml
density() { "$clast" explain "$@" --json | python -c "
import json, sys; print(*[r['value'] for r in json.load(sys.stdin) if r['path'] in ('target.material.name', 'target.material.density')])"; }
same "$(density s.yaml)" "own.yaml 2750" "a file in a scene"
same "$(density s.yaml --set target.material=granite)" "granite 2680" "a name over a file"
same "$(density s.yaml --set target.material=rocks/thin.yaml)" "thin.yaml 2200" "a file over a file"
same "$(density basalt-sphere --set target.material=rocks/own.yaml)" "own.yaml 2750" "a file over a name"
same "$(density s.yaml --set target.material=rocks/thin.yaml --set target.material.density='1 g/cm^3')" "thin.yaml 1000" "a value over a file"
expect 66 "$clast" explain s.yaml --set target.material=none.yaml
says "none.yaml: there is no such file"
expect 66 "$clast" explain s.yaml --set 'target.material.name=thin - thin.yaml'
says "Tables show a rock as its name - its file's name: give the file alone, with its folder"
expect 64 "$clast" explain s.yaml --set material=granite
says "'target.material.name', 'projectile.material.name'"
pores() { "$clast" explain basalt-sphere "$@" --json | python -c "
import json, sys; print(*[round(r['value'], 3) for r in json.load(sys.stdin) if r['path'] == 'target.material.porosity.distention'])"; }
printf 'material: froth\nlike: pumice\nporosity: {fraction: 50 %%}\n' >rocks/froth.yaml
froth=(--set target.material=rocks/froth.yaml)
same "$(pores "${froth[@]}") $(pores "${froth[@]}" --set target.material.porosity.distention=4)" "2 4" "one of two names of a porosity"
printf 'name: mix\nscene: ../s.yaml\nvary: {target.material: [basalt, own.yaml, ./thin.yaml]}\nseeds: 2\n' >rocks/mix.yaml
expect 0 "$clast" run rocks/mix.yaml --quiet
expect 0 "$clast" stats mix.db --by material --csv
prints "basalt,"; prints "own.yaml,"; prints "thin.yaml,"
expect 0 "$clast" run rocks/mix.yaml --quiet
same "$(sqlite3 mix.db "select count(*) from run")" 6 "runs after the same command again"
expect 0 "$clast" plot mix.db bars.png -x material
expect 64 "$clast" stats mix.db --by density # not that of the projectile, which has one value
says "target.material.density follows from target.material.name, which a campaign varies: take that"
expect 0 "$clast" check mix.db
# Values of rocks follow from their names also in a merge whose campaigns begin with other rocks.
sed 's/name: mix/name: back/; s/\[basalt.*\]/[.\/thin.yaml, basalt]/' rocks/mix.yaml >rocks/back.yaml
expect 0 "$clast" run rocks/back.yaml --quiet
expect 0 "$clast" merge mixed.db mix.db back.db
same "$(sqlite3 mixed.db "select group_concat(path) from axis") $(grep -c 'differ in' err)" "target.material.name 0" "inputs of merged rocks"
# Where files of one name give other values, these tell the rocks apart: in merges in any order, of two or three stores.
merged() { # merged TARGET SOURCE...: the inputs, and those that it warns of
  "$clast" merge "$@" >out 2>err || fail "merge $*"
  echo "$(sqlite3 "$1" "select group_concat(path, ' ') from axis") ($(tr -s '\n ' ' ' <err | sed -n 's/.* differ in \([^:]*\):.*/\1/p'))"
}
mkdir dense weak
cp rocks/{mix,own,thin}.yaml dense
sed 's/^density: .*/density: 2.9 g\/cm^3/' rocks/own.yaml >dense/own.yaml
sed 's/^  m: .*/  m: 7/' rocks/own.yaml >weak/own.yaml
cp rocks/thin.yaml weak
for rock in dense weak; do
  cp rocks/mix.yaml $rock/mix.yaml
  expect 0 "$clast" run $rock/mix.yaml --quiet --store $rock-form.db
  sed "s/name: mix/name: $rock/" rocks/mix.yaml >$rock/mix.yaml
  expect 0 "$clast" run $rock/mix.yaml --quiet --store $rock.db
done
density=target.material.density name=target.material.name m=target.material.weibull.m
same "$(merged pair.db mix.db dense.db)" "$density $name ($density)" "inputs of two rocks of one name"
same "$(merged turned.db dense.db mix.db)" "$density $name ($density)" "the other order"
same "$(merged mixed.db dense.db)" "$density $name ($density)" "into a store of merged rocks"
same "$(merged triple.db mix.db dense.db weak.db)" "$density $name $m ($density, $m)" "three rocks of one name"
same "$(merged forms.db mix.db dense-form.db weak-form.db)" "$density $name $m ($density, $m)" "three forms of one campaign"
expect 0 "$clast" stats pair.db --by material,density --csv
same "$(tail -n +2 out | cut -d, -f1,2 | sort | paste -sd ' ')" "basalt,2700 own.yaml,2750 own.yaml,2900 thin.yaml,2200" "means of each rock"
expect 0 "$clast" plot pair.db pair.svg -x material --by density --keep-script
same "$(grep '^label\[' pair.gp | cut -d= -f3 | tr -dc '0-9\n' | paste -sd ' ')" "2200 2700 2750 2900" "lines in the order of their numbers"
expect 0 "$clast" compare mix.db dense.db
tr -s '\n ' ' ' <err | grep -q "a and b also differ in $density (2750 kg/m^3, 2900 kg/m^3) clast:" || fail "compare does not tell the rocks apart"

# A rock is shown by its own name, with the file's; two rocks of one name are refused. A value that a reader expects, once.
mkdir -p other
sed 's/^material: .*/material: weak sandstone/; s/^density: .*/density: 2.2 g\/cm^3/' granite.yaml >other/own.yaml
printf 'name: rocks\nscene: s.yaml\nvary: {target.material: [rocks/own.yaml, other/own.yaml]}\nseeds: 1\n' >rocks.yaml
expect 0 "$clast" run rocks.yaml --quiet
expect 0 "$clast" stats rocks.db --by material --csv
prints "weak sandstone - own.yaml,"; prints "own.yaml,"
expect 0 "$clast" replay rocks.db 2
expect 0 "$clast" run rocks.yaml --quiet
same "$(sqlite3 rocks.db "select count(*) from run")" 2 "runs of two rocks"
expect 64 "$clast" query rocks.db "select target_material from points"
says "The view runs has target_material_name"
expect 64 "$clast" stats rocks.db -Q strength
says "did you mean 'peak_stress'?"
# Bars have the order of the campaign, and a file's name only where two rocks have the same.
sed 's/^density: .*/density: 2.3 g\/cm^3/' other/own.yaml >other/third.yaml
sed 's/, other.own.yaml/, other\/third.yaml&/' rocks.yaml >three.yaml
expect 0 "$clast" run three.yaml --store three.db --quiet
for bars in rocks three; do expect 0 "$clast" plot $bars.db $bars.svg -x material --keep-script; done
bars() { grep '^place\[' "$1.gp" | cut -d"'" -f2 | paste -sd ','; }
same "$(bars rocks) $(bars three)" "own.yaml,weak sandstone own.yaml,weak sandstone - third.yaml,weak sandstone - own.yaml" "names of bars"
sed 's/^material: .*/material: twin/' other/own.yaml >other/twin.yaml # a copy whose values are those of the other file
sed 's/, other.own.yaml/&, other\/twin.yaml/' rocks.yaml >twins.yaml
expect 0 "$clast" plan twins.yaml --no-trial
tr -s '\n ' ' ' <out | grep -q "1 of 3 points have the values of an earlier one, and are one point with it: target.material.name other/twin.yaml as other/own.yaml" || fail "two rocks are one, without a word"
grep -E '^warning +[0-9]+ of' out | tail -n +2 | grep -v ' of 2 points' && fail "a warning counts a point twice"
expect 0 "$clast" run twins.yaml --quiet
says "target.material.name other/twin.yaml as other/own.yaml"
sed -i 's/^material: .*/material: granite/' other/own.yaml
expect 65 "$clast" plan rocks.yaml
says "would have one name in all tables, 'own.yaml'"
printf 'material: stiff\nlike: basalt\nyoung_modulus: 40 GPa\n' >stiff.yaml
printf 'name: stiff\nscene: s.yaml\nset: {target.material: stiff.yaml}\nseeds: 1\n' >set.yaml
expect 65 "$clast" plan set.yaml
says "give bulk_modulus: E / (3 (1 - 2 nu)) and shear_modulus"; one_error
expect 65 "$clast" materials ./stiff.yaml
says "give bulk_modulus: E / (3 (1 - 2 nu)) and shear_modulus"; one_error

# What a scene would doubt is told of a file, too; values without effect are not those of the material that it is like.
printf 'material: odd\nlike: granite\nshear_modulus: 24 GPa\nbulk_modulus: 1 GPa\n' >odd.yaml
expect 0 "$clast" materials ./odd.yaml
says "warning: poisson: "
printf 'material: whole\nlike: pumice\nporosity: {curve: none}\n' >whole.yaml
expect 0 "$clast" materials ./whole.yaml
says "as in pumice: density"; ! grep -q "porosity" err || fail "pores without a curve"

# A fault in a file within a document: its first line only, without an excerpt that has no place in a line.
printf 'material: bare\nlike: basalt\ndensity: 3\n' >bare.yaml
sed 's/stiff.yaml/bare.yaml/' set.yaml >bare-set.yaml
expect 65 "$clast" plan bare-set.yaml
says "bare.yaml:3:10: error: target.material.density: 3 has no unit; write '3 g/cm^3' or '3 kg/m^3'"
grep -q '   density: 3   ' err && fail "an excerpt within a line"

# The identity of a run is its values: the name of the file is no part of it.
printf 'name: a\nscene: s.yaml\nseeds: 1\nstore: same.db\n' >a.yaml
expect 0 "$clast" run a.yaml --quiet
mv rocks/own.yaml rocks/other.yaml
scene rocks/other.yaml >s.yaml
expect 0 "$clast" run a.yaml --quiet
same "$(sqlite3 same.db "select count(*) from run")" 1 "runs of the same rock in another file"

# A material in a file of points is looked for beside that file.
mkdir -p far/points
cp rocks/other.yaml far/points/rock.yaml
printf 'target.material.name\nrock.yaml\nbasalt\n' >far/points/two.csv
printf 'name: two\nscene: %s\ndesign: {file: points/two.csv}\nseeds: 1\nstore: two.db\n' "$PWD/s.yaml" >far/two.yaml
scene basalt >s.yaml
expect 0 "$clast" run far/two.yaml --store two.db --quiet
same "$(sqlite3 two.db "select count(*) from run")" 2 "runs of a file of points with a material's file"

# A file tells at once all that it lacks; one that a body without strength can use is none that is wrong.
printf 'material: bare\n' >bare.yaml
expect 65 "$clast" materials bare.yaml
says "'bare.yaml' lacks density, melt_energy (or off), shear_modulus (or off), tillotson.A"; one_error
"$clast" materials granite | sed '/^yield_stress/d; /^sources/,/^  weibull/d' >most.yaml
expect 0 "$clast" materials most.yaml
says "this is a material for a body without strength; another one refuses it: target.material 'most.yaml' lacks yield_stress (or off)"
"$clast" materials granite | sed '/^tension_limit/d; /^sources/,/^  weibull/d' >most.yaml # which a body without strength needs, too
expect 65 "$clast" materials most.yaml
says "lacks tension_limit (or off)"; one_error
# It judges as a scene does.
printf '%s\n' 'like: pumice' 'porosity: {fraction: 30 %}' >open.yaml
expect 0 "$clast" materials open.yaml
says "clast: as in pumice: density 2327 kg/m^3"; grep -q "porosity.distention" err && fail "the fraction gives the distention"
expect 0 "$clast" explain disruption -s target.material=open.yaml
printf '%s\n' 'like: pumice' 'porosity: {fraction: 30 %, distention: 2}' >both.yaml
for command in "materials both.yaml" "explain disruption -s target.material=both.yaml"; do
  expect 65 "$clast" $command
  says "distention 2 is a fraction of 0.5, but fraction is 0.3: give one of the two"
done
printf '%s\n' 'like: granite' 'sources: {densty: weighed}' >both.yaml
for command in "materials both.yaml" "explain disruption -s target.material=both.yaml"; do
  "$clast" $command >out 2>err && fail "a source of nothing"
  says "'densty' is no value of a material"
done
# A rock of a file is known by the ending of its name.
mkdir -p sub && cp open.yaml sub/open.txt && cp open.yaml sub/open
printf 'engine: sph\ntarget: {material: {file: ./sub/open.txt}}\n' >ending.yaml
for command in "materials sub/open.txt" "explain disruption -s target.material=sub/open.txt" "explain ./ending.yaml"; do
  "$clast" $command >out 2>err && fail "a material's file without its ending"
  says "ends in .yaml, .yml or .json: call it "; says "sub/open.txt.yaml"; one_error
done
expect 65 "$clast" materials ./sub/open
says "call it ./sub/open.yaml"; one_error
expect 66 "$clast" materials ./sub/opem
says "./sub/opem: there is no such file"
# Flaws of two rocks: m of the file, k of the one that it is like.
printf '%s\n' 'like: granite' 'weibull: {m: 9}' >m.yaml
expect 0 "$clast" materials m.yaml
says "weibull.k 1e33 1/m^3"; says "warning: weibull.m is the file's own and weibull.k is that of granite"
expect 0 "$clast" materials rocks/other.yaml
says "moduli: "  # as in each scene with granite

# A scene's own number of its rock: other rocks keep it, and the user is told theirs.
printf 'name: kept\nscene: basalt-sphere\nset: {fidelity.particles: 1000, fidelity.projectile_spacing: 1}\nvary: {target.material: [basalt, granite]}\n' >kept.yaml
expect 0 "$clast" plan kept.yaml --no-trial
tr -s ' \n' ' ' <out | grep -q 'warning fragments.static_strength: the scene gives 1.7e7 Pa .* Their own value would be granite: 1314510 Pa' || fail "granite with the strength of basalt"
expect 0 "$clast" explain basalt-sphere --set target.material=granite
prints "fragments.static_strength: the scene gives 1.7e7 Pa"
sed -i 's/granite\]/granite], fragments.static_strength: {linked: target.material, values: [17 MPa, 1.31 MPa]}/' kept.yaml
expect 0 "$clast" plan kept.yaml --no-trial
grep -q 'the scene gives' out && fail "a number that the campaign gives"
for given in "target.material=basalt" "fragments.static_strength=2e6 Pa" "target.material.weibull.m=9"; do
  "$clast" explain basalt-sphere --set "$given" | grep -q 'the scene gives' && fail "a number of the scene's own rock: $given"
done
# A scene's own value of a material that another one replaces.
printf 'engine: sph\nname: own\ntarget: {radius: 3 cm, material: {name: basalt, weibull: {m: 9}}}\nimpact: {projectile: mass, mass: 0.2 g, speed: 3 km/s}\n' >own.yaml
expect 0 "$clast" explain ./own.yaml --set target.material=granite
prints "target.material.weibull.m: the scene gives 9"

# Pores: the first message names all that they need.
expect 65 "$clast" explain basalt-sphere --set "target.material.porosity.fraction=20 %"
says "remove it, or set target.material.porosity.curve: quadratic and give target.material.porosity.elastic_pressure (Pa), target.material.porosity.solid_pressure (Pa)"
# Lines of many errors keep their blanks, wherever they are broken.
for length in $(seq 30); do
  rock=./$(printf "r%.0s" $(seq "$length")).yaml
  printf 'density: 2.7 g/cm^3\ntillotson: {A: 40 GPa}\n' >"$rock"
  "$clast" materials "$rock" >out 2>err && fail "a rock of two values"
  grep -q 'error:[^ ]' err && fail "a blank is lost"
done
ok "blanks of wrapped errors"
# Rocks of both bodies have one last word: a point tells them by their paths.
printf '%s\n' 'name: both' 'scene: disruption' 'set: {fidelity.particles: 1000}' \
  'vary: {target.material.name: [basalt, granite], projectile.material.name: [nylon, steel]}' 'seeds: {per_point: 2}' \
  'store: both.db' >both.yaml
expect 0 "$clast" plan both.yaml --no-trial
tr '\n' ' ' <out | grep -qE 'point, target.material (basalt|granite), projectile.material (nylon|steel):' || fail "the point is $(cat out)"
ok "rocks of two bodies in the name of a point"
done_after 105
