#!/usr/bin/env bash
# Where newcomers stumbled: words that led nowhere, wide lines, remarks behind --quiet, numbers that cannot be.
. "$(dirname "$0")/lib.bash"

# Everyday words lead to the words of the program.
for word in cube brick block box sphere ball cylinder rod ring disc steel stone hole crack mesh resume; do
  "$clast" explain "$word" >out 2>err || fail "explain $word"
  prints "$word"
done
ok "everyday words"
# Heads of tables lead to their meaning, not to a path that ends so.
for word in best bias level sd ref cpu_s corr cutoff_p pairs runs_as_far q05 below sd_seeds number_density rule_unmet warned; do
  "$clast" explain "$word" >out 2>err || fail "explain $word"
  [ "$(head -1 out)" = "$word" ] || fail "explain $word answers with $(head -1 out)"
done
ok "heads of tables"
for word in alpha_0 alpha0; do
  expect 0 "$clast" explain $word
  prints "target.material.porosity.distention"
done

# A number of per cent without its sign; lines of a plan; heads of a table of two sides.
expect 64 "$clast" simulate basalt-sphere --set target.material.porosity.fraction=20
says "expected at least 0 and at most 0.99, or off, got 20; '20 %' is 0.2"
expect 64 "$clast" simulate basalt-sphere --set target.material.porosity.fraction=200
grep -q '%' err && fail "200 % are no share"
tiny folded
sed -i 's/threshold.angle: .*/threshold.angle: [1.01 deg, 2.01 deg, 3.01 deg, 4.01 deg, 5.01 deg, 6.01 deg, 7.01 deg, 8.01 deg, 9.01 deg, 10.01 deg]/' folded.yaml
expect 0 "$clast" plan folded.yaml --no-trial
[ "$(wc -L <out)" -le 100 ] && grep -q '^over      threshold.strain: 2 %, 5 %$' out || fail "lines of a plan"
expect 0 "$clast" run folded.yaml --seeds 2 --quiet
expect 0 "$clast" compare folded.db:1 folded.db:12
grep -q 'point_\|n_' out && fail "heads that are cut"
prints "a: strain 2 %"

# What depends on a wrong `vary` is not told as an error of `set`, but what does not is.
for shape in 'target.shape: [boxx, box]' 'target.shpe: [box]' 'shape: [boxx]'; do
  printf 'name: g\nscene: basalt-sphere\nset: {target.height: 3 cm}\nvary: {%s}\n' "$shape" >wrong.yaml
  expect 65 "$clast" plan wrong.yaml --no-trial
  one_error
done
printf 'name: g\nscene: basalt-sphere\nset: {target.height: 3 cm}\nvary: {target.material: [basallt]}\n' >wrong.yaml
expect 65 "$clast" plan wrong.yaml --no-trial
says "set.target.height: has no effect"; says "did you mean 'basalt'"

# A path of a table stays whole.
expect 0 "$clast" converge --list
prints "target.material.porosity.curve "
[ "$(wc -L <out)" -le 100 ] || fail "a wide list of knobs"

# A material may be a file; the message is in lines that a terminal shows, and its first line tells the place.
expect 64 "$clast" explain basalt-sphere --set target.material=gneiss
says "or a file such as ./gneiss.yaml"
head -n 1 err | grep -q '^clast: error: target.material.name: expected' || fail "the first line"
one_error
tiny small 'sedes: {per_point: 3}'
expect 65 "$clast" run small.yaml
grep -q '^small.yaml:9:1: error: ' err || fail "the place of an error"

# beta is no number of a run.
tiny beta
sed -i 's/^seeds:.*/seeds: {until: {quantity: beta, half_width: 0.1}, max: 200}/' beta.yaml
expect 65 "$clast" run beta.yaml
says "'beta' is the exponent of all runs of a point together"

# --quiet: an answer and marks, no remarks.
tiny quiet "quantity: fragment_count"
expect 0 "$clast" run quiet.yaml -j 2 --quiet
says "marked (!)"
! grep -q 'not shown\|left out\|resolution\|computed in' err || fail "remarks behind --quiet"

# A count has no interval below 0: in tables, in CSV and in the view.
sed 's/quiet/few/; s/per_point: 3/per_point: 2/' quiet.yaml >few.yaml
expect 0 "$clast" run few.yaml -j 2 --quiet
expect 0 "$clast" stats few.db --by strain,angle -Q fragment_count,dust_fraction,steps --csv
python - <<'PY' || fail "intervals below 0"
import csv, sqlite3
rows = list(csv.DictReader(open("out")))
low = [float(r[q + "_low95"]) for r in rows for q in ("fragment_count", "steps") if r[q + "_low95"]]
wide = [r for r in rows if r["fragment_count_hw95"] and float(r["fragment_count_hw95"]) > float(r["fragment_count_mean"])]
assert low and min(low) >= 0 and wide, (low, wide)
assert sqlite3.connect("few.db").execute("select min(fragment_count_low95) from points").fetchone()[0] >= 0
PY
ok "no interval below 0"
expect 0 "$clast" stats few.db --by strain,angle -Q fragment_count
prints " (0 to "

# Two campaigns of a merged store that share a point: how many runs they have together, and why number 1 is missing.
tiny grow; sed -i 's/\[2 %, 5 %\]/[2 %]/; s/\[2 deg, 6 deg\]/[2 deg]/' grow.yaml
expect 0 "$clast" run grow.yaml -j 2 --quiet
sed -i 's/\[2 %\]/[2 %, 5 %]/' grow.yaml
expect 0 "$clast" run grow.yaml -j 2 --quiet
sed 's/\[2 %, 5 %\]/[5 %, 7 %]/; s/grow.db/other.db/' grow.yaml >other.yaml
expect 0 "$clast" run other.yaml -j 2 --quiet
expect 0 "$clast" merge all.db grow.db other.db
expect 0 "$clast" status all.db
says "left out: 1 earlier form of a campaign"
says "campaigns share 1 point"
says "together they have 9 runs"
expect 0 "$clast" extremes all.db --csv
same "$(grep -c '^grow,' out)" 2 "campaigns without the earlier form of one"
# Tables of pools name the result and the varied inputs; a symbol of a table leads to its result.
expect 0 "$clast" scatter few.db -Q fragment_count
says "values of fragment_count"
head -1 out | grep -q 'strain.*angle.*point' || fail "scatter hides the varied inputs"
expect 64 "$clast" stats few.db -Q M_2/M
says "did you mean 'second_fraction'?"

# The values of an axis stay within 100 columns.
printf 'name: long\nscene: disc-explosion\nvary:\n  threshold.strain: [%s 1 %%]\n' "$(seq -f '%.7f %%,' 1.1234567 0.1 2.5 | tr '\n' ' ')" >long.yaml
expect 0 "$clast" plan long.yaml --no-trial
prints "over      threshold.strain: 1.12"
[ "$(wc -L <out)" -le 100 ] || fail "lines of a plan: $(cat out)"
# So does every word of the measurements that the help of `fit` shows.
"$clast" fit --help >out
words=$(sed -n '/^  name:/,/^$/p' out | grep -oE '[a-z_]+:|count_above' | tr -d : | sort -u)
[ "$(echo "$words" | wc -l)" -ge 12 ] || fail "words of the measurements: $words"
for word in $words share_above specimens; do "$clast" explain "$word" >out 2>err || fail "explain $word"; done
ok "words of measurements"
# Times of a plan without a trial are those of the campaign's own runs, not those of others in the store.
sed 's/: few/: more/; s/\[2 deg, 6 deg\]/[3 deg]/' few.yaml >more.yaml
expect 0 "$clast" plan more.yaml --no-trial
prints "time      not known without a trial run"
expect 0 "$clast" plan few.yaml --no-trial
prints "(from runs in the store)"
expect 0 "$clast" plan few.yaml --no-trial --store elsewhere.db
prints "for the store elsewhere.db"
# Documents of scenes have lines that a terminal shows.
for scene in $("$clast" scenes --csv | tail -n +2 | cut -d, -f1); do
  [ "$("$clast" scenes "$scene" | wc -L)" -le 100 ] || fail "a wide line in scene $scene"
done
ok "scenes in lines"
# A result names all its conditions, also those on which every result rests.
expect 0 "$clast" explain largest_fraction
tr -s ' \n' ' ' <out | grep -q 'Conditions (sph).* coarse, wall, .*(hot); those of every result: drift, .* moduli' || fail "conditions of every result"
grep -q '(command)' out && fail "an engine without conditions"
expect 0 "$clast" explain mean_damage
tr -s ' \n' ' ' <out | grep -q 'those of every result: drift, .* cut' || fail "conditions of every result"
# An exponent without an interval has its mark in the legend.
cat >open.yaml <<'YAML'
name: open
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, threshold.angle: 6 deg, threshold.strain: 5 %}
seeds: {per_point: 6}
YAML
expect 0 "$clast" run open.yaml -j 2 --quiet
grep -q ' [0-9.]*~$' out || fail "no exponent without an interval"
expect 0 "$clast" estimates open.db
says "beta with ~: no interval, since without one of the runs a bin is empty"
grep -q 'weak, too few' err && fail "a share is called weak that is not"
expect 0 "$clast" explain weak
prints "a bin is empty (LSQ)"
# The material of a point is called as in tables; a store that is not there has no study, and says which of the two.
printf 'name: rocks\nscene: basalt-sphere\nset: {fidelity.particles: 1000, fidelity.projectile_spacing: 1}\nvary: {target.material: [basalt, granite]}\n' >rocks.yaml
expect 0 "$clast" plan rocks.yaml --no-trial
prints "the most expensive point, material "
printf 'name: bars\nscene: uniaxial\nvary: {beam.young_modulus: [5 GPa, 6 GPa]}\n' >bars.yaml
expect 0 "$clast" plan bars.yaml --no-trial
prints "the most expensive point, beam.young_modulus " # young_modulus alone is a result
tiny exact 'accuracy: {quantity: largest_fraction, within: 5 %}'; sed -i /^seeds/d exact.yaml
expect 65 "$clast" plan exact.yaml --no-trial
says "accuracy: exact.db does not exist yet, so it has no study of largest_fraction"
# No run has an exponent of its own, and commands that need one say so.
for command in scatter sensitivity; do
  expect 64 "$clast" "$command" open.db -Q beta
  says "'beta' is an exponent of all runs of a point together"
done
expect 0 "$clast" explain impact.angle
prints "+x"
# A plot tells of weak intervals, as a map does.
expect 0 "$clast" run few.yaml --seeds 3 --quiet
expect 0 "$clast" plot few.db weak.svg -x strain --by angle -Q largest_fraction
tr -s '\n' ' ' <weak.svg | sed 's/<[^>]*>/ /g' | tr -s ' ' | grep -q 'of the marks: a weak interval' || fail "a plot without a word on weak intervals"
# The command below the table of a run takes a store with a blank in its name.
printf '%s\n' 'name: one plate' 'scene: porous-plate' 'set: {fidelity.points: 50}' 'seeds: 2' >plate.yaml
expect 0 "$clast" run plate.yaml
next=$(sed -n 's/^fragments, .*: clast /"$clast" /p' err)
expect 0 bash -c "clast='$clast'; $next"
# Grains have no rocks; the point that cannot be run is named.
expect 64 "$clast" simulate disc-collision --set target.material=basalt
says "has no 'target.material': grains of dem are of no rock; their values are grain.*, beam.*"; one_error
printf '%s\n' 'name: min' 'scene: disruption@draft' 'set: {fidelity.particles: 1200}' 'vary:' '  target.material: [basalt, ice]' \
  '  impact.specific_energy: [300 J/kg, 3000 J/kg]' >min.yaml
expect 65 "$clast" find min.yaml --input specific_energy --set target.material=basalt --level 0.5
says "(at target.material.name ice, impact.specific_energy 300 J/kg)"; one_error
done_after 54
