# What screens say beside their numbers: units, names and marks, commands that are offered, and options given twice.
. "$(dirname "$0")/lib.bash"

tiny small
expect 0 "$clast" run small.yaml -j 2 --quiet

# A density without its unit, a place without its unit.
expect 64 "$clast" spectrum small.db --size 2.7
says "2.7 has no unit; write '2.7 kg/m^3' or '2.7 g/cm^3'"
expect 0 "$clast" spectrum small.db --point 4 --size "2.7 g/cm^3"
prints "lower [m]"; prints "[m^-1]"
expect 0 "$clast" spectrum small.db --point 4
prints "[kg/m]   [kg/m]"; prints "number_density [m/kg]"
expect 0 "$clast" query small.db "SELECT run_id, total_mass FROM runs"
prints "total_mass [kg/m]"
# Two meanings, two names: fragments per kg and run here, the share of the fragments per kg in the view spectra.
expect 0 "$clast" spectrum small.db --point 4 --csv
python - <<'PY' || fail "number_density"
import csv, sqlite3
view = dict(sqlite3.connect('file:small.db?mode=ro', uri=True).execute('select round(lower, 9), count_mean / (upper - lower) from spectra where point_id = 4'))
rows = list(csv.DictReader(open('out')))
assert rows and 'density' not in rows[0] and all(abs(float(r['number_density']) / view[round(float(r['lower']), 9)] - 1) < 1e-9 for r in rows), rows
PY
printf '%s\n' '# source: made up' 'mass (kg), count' 0.1,3 0.4,6 1.5,4 6,1 >measured.csv
expect 0 "$clast" spectrum small.db --point 4 --with measured.csv
says "on; lightest mass: the first measured class there"
printf '%s\n' '# source: made up' 'mass (kg)' 0.4 1.5 1.6 6 >measured.csv
expect 0 "$clast" spectrum small.db --point 4 --with measured.csv
says "on; lightest mass: this mass"
same "$(tr '\n' ' ' <err | sed 's/.*complete from \([^ ]*\) .*/\1/')" "$("$clast" spectrum small.db --point 4 --with measured.csv --csv 2>err | python -c 'import csv, sys; print("%.3g" % float(next(csv.DictReader(sys.stdin))["from"]))')" "where the comparison begins"
# A fit leaves the largest fragments out, and the marks have them.
expect 0 "$clast" run small.yaml --seeds 40 --store many.db -j 2 --quiet
expect 0 "$clast" spectrum many.db --point 4 --picture many.png --keep-script
grep -q 'the largest of each run left out' many.gp && tr '\n' ' ' <many.gp | sed "s/'\.\"[^ ]*\"\.'/ /g" | grep -q 'Lines leave out the largest fragment of each run' || fail "no word on the largest fragments"
# Bars end within the frame, also wide ones of few runs.
expect 0 "$clast" spectrum small.db --point 4 --picture few.png --keep-script
python - <<'PY' || fail "bars that the frame cuts"
import re
high = [float(l.split()[3]) for l in open("few.dat") if l.strip() and l[0] != "#" and len(l.split()) == 5]
frame = float(re.search(r"y_high = ([0-9.e+-]+)", open("few.gp").read())[1])
assert len(high) > 4 and max(h for h in high if h == h) < frame, (high, frame)
PY
expect 0 "$clast" spectrum many.db --point 4 --cumulative --picture sums.png --keep-script
python - <<'PY' || fail "the cumulative line is beside its marks"
marks, line = ([[float(x) for x in l.split()] for l in block.splitlines() if l and l[0] not in "#N"] for block in open("sums.dat").read().split("\n\n\n")[:2])
heavy = [m for m in marks if m[2] == m[2] and line[0][0] <= m[0] <= line[-1][0] and m[0] > 10] # where most runs have their largest only
near = lambda place: min(line, key=lambda p: abs(p[0] - place))[1]
assert len(heavy) >= 2 and all(low <= near(place) <= high for place, _, low, high, _ in heavy), (heavy, line)
PY
ok "the cumulative line counts each largest fragment once"
expect 0 "$clast" estimates many.db
says "without the largest of each run (ML)"

# Options given twice: names together, anything else not.
expect 0 "$clast" stats small.db --by strain --quantity largest_fraction --quantity second_fraction --csv
cp out both.csv
expect 0 "$clast" stats small.db --by strain --quantity largest_fraction,second_fraction --csv
cmp -s out both.csv || fail "two options --quantity are not those of one"
expect 64 "$clast" plot small.db m.png -x strain --by angle -Q dust_fraction -Q largest_fraction
says "--quantity is given twice, as \"dust_fraction\" and \"largest_fraction\": leave one of them out"
expect 64 "$clast" estimates small.db --point 1 --point 2
says "--point is given twice, as 1 and 2"
expect 0 "$clast" estimates small.db --point 1 --point 1
expect 64 "$clast" converge uniaxial --knob grains=1cm --knob grains=2cm -Q young_modulus --store twice.db
says "--knob is given twice, as \"grains=1cm\" and \"grains=2cm\": leave one of them out"

# The marks of a search are those of stats, and the table says what its rows are.
cat >search.yaml <<'YAML'
name: search
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.least_time: 1 ms}
vary: {threshold.strain: {log_uniform: [1 %, 8 %]}}
design: {kind: latin_hypercube, points: 8, seed: 3}
seeds: {per_point: 3}
YAML
expect 0 "$clast" find search.yaml --level 0.25 --max-runs 20 --store found.db
weak=$(grep -c '~' out || true)
says "one row, from its least to its largest value"
[ "$weak" -gt 0 ] || fail "no weak mean is marked"
says "~: weak, too few runs"
ok "$weak weak means"

# One run: the command that is offered studies this scene. Settings and inputs carry no mark, results do.
expect 0 "$clast" simulate basalt-sphere --set fidelity.particles=1200 --set 'impact.speed=3 km/s' --all
tr '\n' ' ' <out | grep -qF "\`clast converge basalt-sphere --set fidelity.particles=1200 --set 'impact.speed=3 km/s'\` measures it" || fail "another scene is offered"
for fact in target_mass projectile_mass energy_input limited.courant; do
  grep -qE "^$fact +[0-9.e-]+( |$)" out && ! grep -qE "^$fact +[^ ]+ !" out || fail "$fact is marked"
done
grep -qE '^largest_fraction +[0-9.]+ !' out || fail "a result in doubt is not marked"
ok "marks are on results"

# A measured quantity that every run withholds is refused before any run, one without a value is named.
cat >unknown.yaml <<'YAML'
name: unknown
scene: basalt-sphere
set: {fidelity.particles: 1000}
vary: {weibull.m: {uniform: [7, 10]}}
design: {kind: latin_hypercube, points: 8, seed: 3}
seeds: {per_point: 2}
store: fit.db
YAML
measured() { printf 'name: m\nsource: made up\nshots:\n  - name: fast\n    measured:\n      - {quantity: %s, value: 0.4, error: 0.05, resolution: 0.02}\n' "$1" >shots.yaml; }
measured dust_fraction
expect 65 "$clast" fit shots.yaml unknown.yaml --quiet
says "dust_fraction: every run withholds it: fragments.dust_mass in the heaviest particles is below 2 (clast explain dust)"
[ ! -e fit.db ] || fail "runs were computed"
# In a graded body the heaviest particles need not come off: only the end of a run tells.
sed 's/^set: .*/set: {fidelity.graded: true, fidelity.spacings_per_radius: 3, fidelity.coarsest: 3, fidelity.particles: 1200, fidelity.projectile_spacing: 1, impact.gap: 1 um, stop.end_time: 20 us, fragments.dust_mass: 1.5 g}/; s/basalt-sphere/disruption/' unknown.yaml >graded.yaml
expect 0 "$clast" fit shots.yaml graded.yaml --quiet --rounds 3 --store graded.db -j 2
sed 's/basalt-sphere/disc-explosion/; s/set: .*/set: {body.diameter: 6 cm, charge.energy: 1 kJ\/m, stop.end_time: 1 ms}/; s/vary: .*/vary: {threshold.strain: {uniform: [1 %, 8 %]}}/' unknown.yaml >disc.yaml
measured poisson_ratio
expect 65 "$clast" fit shots.yaml disc.yaml --quiet -j 2
says "poisson_ratio: no point has two runs with a value"
measured largest_fraction
expect 0 "$clast" fit shots.yaml disc.yaml --rounds 3 --quiet -j 2

# The error of the resolution below a search is that of its own point nearest to the answer, and the study offered is of it.
expect 0 "$clast" find search.yaml --level 0.25 --max-runs 20 --store found.db
study=$(tr '\n' ' ' <err | grep -o '`clast converge [^`]*`' | tr -d '`')
says "largest_fraction at threshold.strain = "
eval "expect 0 '$clast' ${study#clast} --knob time_step --seeds 2 --within off --quiet"
expect 0 "$clast" find search.yaml --level 0.25 --max-runs 20 --store found.db
says "(resolution: time_step)"
grep -qF "studied at" err && fail "a search tells of points that are not its own"

# Advice keeps the store and the inputs of the command.
sed '/^seeds/d' small.yaml >near.yaml
echo 'accuracy: {quantity: largest_fraction, within: 0.01}' >>near.yaml
expect 65 "$clast" plan near.yaml --set body.diameter='7 cm' --store other.db
says "\`clast converge near.yaml --set 'body.diameter=7 cm' --store other.db --quantity largest_fraction\`"
# In another folder the file is named from there.
mkdir -p below
(cd below && "$clast" stats ../small.db >../out 2>../err) || fail "stats from another folder"
says "\`clast converge ../small.yaml --store ../small.db -Q largest_fraction\` measures it"
eval "expect 0 '$clast' converge near.yaml --set 'body.diameter=7 cm' --store other.db --quantity largest_fraction --knob time_step --seeds 2 --within off --quiet"
"$clast" plan near.yaml --set body.diameter='7 cm' --store other.db --no-trial >out 2>err || true
same "$(tr '\n' ' ' <err | grep -o '`clast [^`]*`' | grep -cv "clast [a-z]* near.yaml --set 'body.diameter=7 cm' --store other.db " || true)" 0 "advice without its store"

# Graded scenes: fewer particles than are needed are refused with the number that is enough. Where fidelity.coarsest makes
# the zone coarser than asked, its message says from which number on it does not.
zone=(basalt-sphere --set graded=true --set spacings_per_radius=5 --set projectile_spacing=1)
expect 65 "$clast" explain "${zone[@]}" --set particles=2000
least=$(sed -n 's/.* gives \([0-9]*\) to .*/\1/p' err)
expect 0 "$clast" explain "${zone[@]}" --set particles="$least"
prints "5 spacings in its radius"; prints "in doubt: dust: fragments.dust_mass in the heaviest particles is 0.3, below 2"
expect 0 "$clast" explain coarse
tr '\n' ' ' <out | grep -qF "a message says" || fail "no word on the number of particles"
grep -qF 7700 out && fail "another number of particles"
expect 0 "$clast" explain porous-ice --set particles=3000
least=$(tr '\n' ' ' <out | sed -n 's/.*below 5: fidelity.coarsest 4 allows the 5 of spacings_per_radius from \([0-9]*\) particles on.*/\1/p')
expect 0 "$clast" explain porous-ice --set particles="$least"
prints "; 5 spacings in its radius"
grep -qF "fidelity.coarsest 4 allows" out && fail "the number is not enough"
expect 0 "$clast" explain porous-ice --set particles=$((least - 20))
prints "fidelity.coarsest 4 allows"

# A number at its bound is not beyond it, and one near it has the digits that tell them apart.
cat >dusty.yaml <<'YAML'
name: dusty
scene: basalt-sphere
set: {particles: 2000}
vary: {weibull.m: [8, 9]}
YAML
expect 0 "$clast" plan dusty.yaml --no-trial
grep -qF "dust_mass in the heaviest particles" out && fail "two particles are below two"
expect 0 "$clast" plan dusty.yaml --no-trial --set particles=1999
tr '\n' ' ' <out | grep -qF "particles is 1.999, below 2" || fail "2, below 2"

# A map has the digits of the table.
expect 0 "$clast" map many.db small.svg -x strain -y angle -Q energy_error
grep -qE '>0\.0+( !)?<' small.svg && fail "a map shows nothing of a small number"
grep -qE '>0\.000[0-9]{2}( !)?<' small.svg || fail "no small number on the map"

# Means that the scatter over seeds hides: the table has the interval of the sentence, and a note says why.
cat >noise.yaml <<'YAML'
name: noise
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
vary: {threshold.strain: {uniform: [3 %, 3.4 %]}, threshold.angle: {uniform: [4 deg, 4.3 deg]}}
design: {kind: latin_hypercube, points: 16, seed: 3}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run noise.yaml --quiet -j 2
expect 0 "$clast" sensitivity noise.db
prints "of single runs"
says "shares of means are not told"
grep -qE '^strain .* [0-9.]+ (± |\([0-9.]+ to )[0-9.]+' out || fail "the table hides the interval"

# Bins below the mass from which the spectrum is complete are marked for people.
expect 0 "$clast" spectrum small.db --point 4
says "complete no: "
complete=$(number small.db "select max(complete_mass) from runs where point_id = 4")
awk -v c="$complete" '$1 == 4 && ($2 == "no") != ($3 < c * 0.99999) { exit 1 }' out || fail "bins are not marked as the picture marks them"

# Small quantiles have their digits.
sed -i 's/quantity: .*/quantity: first_break, value: 11 us, error: 1 us, resolution: 0 s}/' shots.yaml
expect 0 "$clast" fit shots.yaml disc.yaml --rounds 3 --quiet -j 2
grep -qE '^first_break .* [0-9.]+×10\^-[56] \(([0-9.]+×10\^-6|0) to [0-9.]+×10\^-5\)' out || fail "quantiles of a small number"

# Advice of more seeds keeps the levels of the study, and can be typed. Points without runs are no rows for people.
cat >levels.yaml <<'YAML'
name: levels
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
accuracy: {quantity: largest_fraction, within: 0.1}
YAML
expect 0 "$clast" converge levels.yaml --knob grains=10.69mm,8mm,6mm,5mm --seeds 16 --max-seeds 16 --within off --quiet -j 2
expect 0 "$clast" estimates levels.db --studies
says "without runs"
grep -qE '^ +[0-9]+ +[^ ]+ +0 ' out && fail "a point without runs is a row"
expect 0 "$clast" estimates levels.db --studies --csv
python -c 'import csv; assert any(r["n"] == "0" for r in csv.DictReader(open("out")))' || fail "programs lack points without runs"
expect 65 "$clast" plan levels.yaml --no-trial
says "--knob grains=0.01069m,0.008m,0.006m,0.005m --max-seeds "
advice=$(tr '\n' ' ' <err | grep -o '`clast converge [^`]*`' | tr -d '`' | sed -E 's/seeds [0-9]+/seeds 18/g')
eval "expect 0 '$clast' ${advice#clast} --quiet -j 2"
same "$(number levels.db "select count(*) from convergence where n = 18")" 4 "levels of the larger study"

expect 0 "$clast" explain withheld
prints '"-" in tables'

done_after 55
