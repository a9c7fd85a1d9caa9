# Pictures and plots as a user meets them: spectra, maps and bodies from a store that a campaign filled, and what is said
# when they cannot be drawn.
. "$(dirname "$0")/lib.bash"

tiny small
expect 0 "$clast" run small.yaml -j 2

is_png() { [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"; ok "$1 is a PNG"; }
caption() { grep '^caption_text' "$1" | sed "s/'\\.\"\\\\n\"\\.'/ /g"; } # in one line
is_svg() { head -c 200 "$1" | grep -q '<svg\|<?xml' && tail -c 20 "$1" | grep -q '</svg>' || fail "$1 is no whole SVG"; ok "$1 is an SVG"; }

expect 0 "$clast" spectrum small.db --picture spectrum.png
is_png spectrum.png
# --where and --by choose the same runs for the table and the picture.
choice=(small.db --where "threshold_strain < 0.03 AND replicate > 0" --by strain)
expect 0 "$clast" spectrum "${choice[@]}" --csv --picture chosen.png --keep-script
python - <<'PY'
import csv, sqlite3
rows = list(csv.DictReader(open("out")))
assert all(float(r["threshold_strain"]) == 0.02 and r["runs"] == "4" and r["points"] == "2" for r in rows)
db = sqlite3.connect("small.db")
(n,) = db.execute("select sum(fragment_count) from runs where counts and threshold_strain < 0.03 and replicate > 0").fetchone()
assert sum(int(r["fragments"]) for r in rows) == n, n
drawn = [float(l.split()[1]) for l in open("chosen.dat").read().split("\n\n\n")[0].splitlines() if l and l[0] not in "#" and "NaN" not in l.split()[1]]
assert len(drawn) == len(rows) and all(abs(d / float(r["number_density"]) - 1) < 1e-5 for d, r in zip(drawn, rows)), (drawn, rows)
PY
ok "a condition and an input choose the same runs for table and picture"
# Pooled points: why there is no line, and nothing of the exponent that is not drawn.
caption chosen.gp >caption
grep -q "No line: .*2 points, 4 runs.* (each of its points has a law of its own)" caption || fail "no word why pooled points have no line"
grep -q "resolution:" caption && fail "resolution of an exponent that is not drawn"
ok "pooled points have no law, and the caption says so"
expect 64 "$clast" spectrum small.db --by nothing
expect 64 "$clast" spectrum small.db --where "replicate > 99"
says "small.db: none of the runs meets --where \"replicate > 99\""

# Beside a measured spectrum: cumulative, by size.
printf '%s\n' '# source: <made up>' '# complete from: 0.3 kg' 'mass (kg), count' 0.1,3 0.4,6 1.5,4 6,1 >measured.csv
expect 0 "$clast" spectrum small.db --with measured.csv --csv
python - <<'PY'
import csv
rows = list(csv.DictReader(open("out")))
assert len(rows) == 4 and all(float(r["from"]) >= 0.3 and 0 <= float(r["distance"]) <= 1 for r in rows), rows
assert len({r["from"] for r in rows}) == 1 # likelihoods are comparable
PY
ok "distances from a measured spectrum"
# One number of fragments with one interval, over points and the seeds that they share: beside a measured spectrum, as N(>m),
# and in the statistics.
printf '%s\n' '# complete from: 1 kg/m' 'mass (kg/m)' 1 2 5 >whole.csv
expect 0 "$clast" spectrum small.db --by strain --with whole.csv --csv
cp out with.csv
expect 0 "$clast" spectrum small.db --by strain --cumulative --csv
cp out above.csv
expect 0 "$clast" stats small.db --by strain -Q fragment_count --csv
python - <<'PY'
import csv
near = lambda a, b: abs(float(a) - float(b)) < 1e-9 * float(b)
beside, above, stats = [list(csv.DictReader(open(f))) for f in ("with.csv", "above.csv", "out")]
assert len(beside) == len(stats) == 2, beside
for b, s in zip(beside, stats):
    n = [r for r in above if r["threshold_strain"] == b["threshold_strain"] == s["threshold_strain"]]
    from_1 = [r for r in n if near(r["lower"], 1)][0]
    assert near(b["fragments_mean"], from_1["number"]) and near(b["fragments_hw95"], from_1["number_hw95"]), (b, from_1)
    assert near(n[0]["number"], s["fragment_count_mean"]) and near(n[0]["number_hw95"], s["fragment_count_hw95"]), (n[0], s)
PY
ok "one interval of the number of fragments"
expect 0 "$clast" spectrum small.db --point 1 --with measured.csv # the first line answers
head -2 out | tr '\n' ' ' | grep -Eq '^no verdict on the shape: it needs 20 runs .* has [0-3] ' || fail "no word on 3 runs"
tr '\n' ' ' <out | grep -q 'from the lightest mass on, and has' || fail "runs from which mass on"
# How much the specimen weighed is not known where light fragments were not collected.
printf 'mass (kg/m)\n3\n2\n' >light.csv
expect 0 "$clast" spectrum small.db --point 1 --with light.csv
says "give the body of the scene the size of the specimen"
(echo '# complete from: 1.5 kg/m'; cat light.csv) >partial.csv
expect 0 "$clast" spectrum small.db --point 1 --with partial.csv
grep -q "size of the specimen" err && fail "a part of the fragments is taken for all"
# Why there is no distance: what is missing is named.
printf 'mass (kg), count\n5000, 3\n' >heavy.csv
expect 0 "$clast" spectrum small.db --point 1 --with heavy.csv
says 'no distance: from the lightest mass on there is no simulated fragment. The heaviest'
printf 'mass (kg)\n1e-9\n' >lone.csv
expect 0 "$clast" spectrum small.db --point 1 --with lone.csv
says 'no distance: from the lightest mass on there is at most one measured fragment. The heaviest'
expect 0 "$clast" run small.yaml --seeds 40 --store many.db -j 2
far=$("$clast" spectrum many.db --point 1 --with measured.csv --json | sed -n 's/.*runs_as_far": \([0-9.]*\).*/\1/p')
expect 0 "$clast" spectrum many.db --point 1 --with measured.csv
same "$(head -1 out | cut -d' ' -f1-3)" "$(awk "BEGIN {print $far < 0.05 ? \"differs\" : \"agrees\"}") in shape," "verdict of $far"
expect 0 "$clast" spectrum many.db --point 1 --csv
python - <<'PY' # twenty quantiles of the simulated fragments are nearer to all of them than any run is
import csv
bins = [[float(row[name]) for name in ("lower", "upper", "fragments")] for row in csv.DictReader(open("out"))]
masses = [a + (i + 0.5) / n * (b - a) for a, b, n in bins if a > 0.5 for i in range(round(n))]
print("mass (kg/m)", *masses[len(masses) // 40::len(masses) // 20], sep="\n", file=open("pooled.csv", "w"))
PY
expect 0 "$clast" spectrum many.db --point 1 --with pooled.csv
prints "number of fragments: 100 % of the runs"
expect 0 "$clast" spectrum small.db --with measured.csv --cumulative --size "5000 kg/m^3" --runs --picture beside.svg
is_svg beside.svg
grep -q 'measured: &lt;made up>' beside.svg || fail "the source of the measured spectrum is not in the picture"
grep -q 'N(>L), fragments' beside.svg && grep -q 'intervals over seeds' beside.svg || fail "the picture does not tell its axes and errors"
expect 0 "$clast" spectrum many.db --point 4 --cumulative --picture line.svg # it has a line
grep -q 'of β, resolution: not studied' line.svg && ! grep -q 'No line' line.svg || fail "the picture does not tell the errors of its line"
ok "what was measured is drawn, and the errors are told"
printf '%s\n' 'mass (kg);passing (%)' '0,1;12,5' '0,4;21,5' '1,5;40' '2,5;60' '6;100' >sieves.csv
expect 0 "$clast" spectrum small.db --with sieves.csv --csv
python - <<'PY'
import csv
rows = list(csv.DictReader(open("out")))
assert len(rows) == 4 and all(0 <= float(r["distance"]) <= 1 and r["measured"] == r["log_likelihood"] == "" for r in rows), rows
PY
expect 0 "$clast" spectrum small.db --point 1 --with sieves.csv --picture sieves.svg --keep-script
tr '\n' ' ' <sieves.gp | grep -q "number of a class from its share of a body of" || fail "the sieve table has no curve, or no mass"
sed '2,3d' sieves.csv >coarse.csv # simulated fragments pass, other shares of each point
for p in 1 4; do
  expect 0 "$clast" spectrum small.db --point $p --with coarse.csv --picture coarse-$p.svg --keep-script
done
python - <<'PY'
def sieve(path): # the second block: the fits come after it
    return [[float(x) for x in l.split()[:2]] for l in open(path).read().split("\n\n\n")[1].splitlines() if l and l[0] != "#"]
one, other = sieve("coarse-1.dat"), sieve("coarse-4.dat")
assert len([r for r in one if r[1] > 0]) >= 2, one
assert all(a[0] == b[0] and abs(a[1] / b[1] - 1) < 1e-5 for a, b in zip(one, other) if a[1] > 0), (one, other)
PY
ok "marks of a sieve table do not move with the point"
grep -q "has no upper end" sieves.gp && fail "a sieve table without a mass above its last sieve has an open class"
sed 's/6;100/6;90/' sieves.csv >open.csv
expect 0 "$clast" spectrum small.db --point 1 --with open.csv --picture open.svg --keep-script
caption open.gp >caption
grep -q "class from 6 kg/m on has no upper end and is drawn only in N(>m)" caption || fail "an open class is left out without a word"
expect 0 "$clast" spectrum small.db --point 1 --with open.csv --cumulative --picture open.svg --keep-script
grep -q "has no upper end" open.gp && fail "N(>m) has the open class"
ok "shares of mass from a sieve table, and their curve"
expect 0 "$clast" spectrum small.db --point 1 --runs --cumulative --json
python -c "
import json; rows = json.load(open('out'))
first = {}
for r in rows: first.setdefault(r['run_id'], r)
assert len(first) == 3 and all(r['number'] == r['fragments'] and r['mass_share'] == 1 for r in first.values())"
ok "every run by itself"
expect 64 "$clast" spectrum small.db --size "5 m"
expect 65 "$clast" spectrum small.db --with small.yaml
expect 66 "$clast" spectrum small.db --with none.csv

printf '%s\n' '# density: 2.7 g/cm^3' 'size (mm), retained (%)' '31.5, 40' '16, 50' '8, 30' >twice.csv
expect 65 "$clast" spectrum small.db --with twice.csv
says "120 % of the mass are in its classes; name the column cumulative retained (%) if 'retained' is"
# Thin lines are explained, and a missing line names its spectrum.
expect 0 "$clast" run small.yaml --store few.db --set stop.end_time='10 us' --quiet
expect 0 "$clast" spectrum few.db --point 1 --with whole.csv --runs --picture few.svg --keep-script
caption few.gp >caption
grep -q "Thin lines: single runs" caption || fail "thin lines without a word"
grep -q "No line: .*3 runs.* (β not known: fewer than 5 fragments)" caption || fail "of which spectrum is there no line?"
ok "thin and missing lines"

expect 0 "$clast" map small.db map.svg -x strain -y angle
is_svg map.svg
# A panel for each value of a third input. Two points are left out of the store: their places are crossed.
cat >three.yaml <<YAML
name: three
scene: disc-explosion
design: list
vary:
  threshold.strain: [2 %, 5 %, 2 %, 5 %, 2 %, 5 %]
  threshold.angle: [2 deg, 2 deg, 6 deg, 2 deg, 2 deg, 6 deg]
  charge.energy: [1 kJ/m, 1 kJ/m, 1 kJ/m, 2 kJ/m, 2 kJ/m, 2 kJ/m]
set: {body.diameter: 6 cm}
seeds: {per_point: 2}
store: three.db
YAML
expect 0 "$clast" run three.yaml -j 2 --quiet
expect 0 "$clast" map three.db three.svg -x strain -y angle --by energy --keep-script
caption three.gp >caption
grep -q "×: no usable run" caption || fail "a cross that nothing explains"
expect 0 "$clast" stats three.db --by strain,angle,energy --json
python - <<'PY'
import json, re
means = {tuple(round(r[k], 6) for k in ('threshold_strain', 'threshold_angle', 'charge_energy')): (r['largest_fraction_mean'], r['largest_fraction_weak'])
         for r in json.load(open('out'))}
strains, angles, energies = (sorted({k[i] for k in means}) for i in range(3))
rows = [[float(v) for v in l.split()] for l in open('three.dat').read().split('\n\n\n')[0].splitlines() if l[0] != '#']
assert len(means) == 6 and len(rows) == 10, rows
kinds = [0, 0, 0]
for column, row, value, _, _, kind, weak in rows:
    kinds[int(kind)] += 1
    panel, i = divmod(int(column), 3)
    mean, is_weak = means.get((strains[i], angles[int(row)], energies[panel]), (None, 0)) if i < 2 else (None, 0)
    assert weak == is_weak, (column, row, weak)
    assert kind == (2 if i == 2 else 1 if mean is None else 0), (column, row, kind)
    assert mean is None or abs(value - mean) < 1e-8, (column, row, value, mean)
assert kinds == [6, 2, 2], kinds
weak = sum(w for _, w in means.values())
assert 0 < weak == len(re.findall(r'>[-0-9.e]+~', open('three.svg').read())), (weak, means)
assert f'; ~, {weak} of 6: weak, too few runs' in open('three.gp').read()
PY
ok "each panel of a map has the means of its value"
expect 64 "$clast" map three.db m.png -x strain -y angle --by angle

expect 0 "$clast" plot small.db lines.png -x strain --by angle
is_png lines.png
expect 0 "$clast" plot small.db dust.svg -x strain -Q dust_fraction
is_svg dust.svg
expect 0 "$clast" plot small.db apart.svg -x strain --by angle -Q dust_fraction
tr '\n' ' ' <dust.svg | grep -q 'beams in angle' || fail "a mean over angles, too, does not say so"
grep -q 'seeds and' apart.svg && fail "a line for each angle is no mean over angles"
grep -q 'threshold of beams in strain' apart.svg || fail "the axis has no readable name"
expect 0 "$clast" plot small.db beta.svg -x strain --by angle -Q beta_masses_from_2 --keep-script
expect 0 "$clast" estimates small.db --json
# The numbers that gnuplot draws are those of the table.
python - <<'PY'
import json
rows = [r for r in json.load(open('out')) if r['window'] == 'from_2']
drawn = [[[float(v) for v in l.split()] for l in block.splitlines() if l and l[0] != '#']
         for block in open('beta.dat').read().split('\n\n\n') if block.strip()]
angles = sorted({r['threshold_angle'] for r in rows})
assert len(drawn) == len(angles) == 2, drawn
for angle, line in zip(angles, drawn):
    table = sorted((r['threshold_strain'], r['beta_masses'], r['beta_masses_untold']) for r in rows if r['threshold_angle'] == angle)
    assert len(table) == 2 and all(abs(x - 100 * a) < 1e-8 and (y != y if why else abs(y - b) < 1e-8) for (x, y, *_), (a, b, why) in zip(line, table, strict=True)), (line, table)
assert 0 < len([r for r in rows if r['beta_masses_untold']]) < len(rows) == 4, rows
PY
ok "the picture shows the table's exponents"
# An exponent that the table for people refuses is in no picture, which gives the reason; the file for programs has both.
expect 0 "$clast" map small.db beta.png -x strain -y angle -Q beta_masses_from_2 --keep-script
expect 0 "$clast" estimates small.db --json
python - <<'PY'
import json
rows = {(round(100 * r['threshold_strain'], 6), round(r['threshold_angle'] * 57.29577951308232, 6)): r for r in json.load(open('out')) if r['window'] == 'from_2'}
columns, rows_of = (sorted({k[i] for k in rows}) for i in range(2))
drawn = [l.split() for l in open('beta.dat').read().split('\n\n\n')[0].splitlines() if l[0] != '#']
for column, row, value, doubtful, _, kind, weak in drawn:
    r = rows[columns[int(column)], rows_of[int(row)]]
    assert (kind == '1' and value == 'NaN' and doubtful == weak == '0') if r['beta_masses_untold'] else abs(float(value) - r['beta_masses']) < 1e-8, (r, value)
    assert r['beta_masses'] is not None and (r['beta_masses_untold'] == 'an interval of ± 2 or wider') == ((r['beta_masses_hw95'] or 0) >= 2), r
PY
tr '\n' ' ' <beta.gp | sed "s/'\.\"[^ ]*\"\.'/ /g" >beta.txt
grep -q '×: the exponent is too uncertain to print: an interval of ± 2 or wider' beta.txt || fail "no reason in the caption of the map"
expect 0 "$clast" estimates small.db
same "$(awk '$NF == "-" && /from_2/ {n += $0 ~ /from_2 +[0-9]+ +- /} END {print n}' out)" "$(awk 'NF == 7 && $6 == 1' beta.dat | wc -l)" "exponents that neither table nor map has"
says "beta -: the exponent is too uncertain to print: an interval of ± 2 or wider"
withheld=$(awk '$NF == "-" && /from_2/ {n += $0 ~ /from_2 +[0-9]+ +- /} END {print n}' out)
expect 0 "$clast" compare small.db small.db -Q beta_masses_from_2
same "$(grep -c ' 3  *3  *[0-9]*  *-  *-  *-$' out)" "$withheld" "exponents that a comparison does not have either"
says "clast: beta_masses_from_2 -: the exponent is too uncertain to print: an interval of ± 2 or wider"
expect 0 "$clast" compare small.db small.db -Q beta
says "\`-Q beta_masses_from_2\` takes lighter fragments, too"
expect 64 "$clast" map small.db none.png -x strain -y angle -Q beta
says "no point has an exponent to draw: the exponent is too uncertain to print: fewer than 5 fragments"
# The command in a caption has the quantity, and its interval is none the narrower.
for of in beta_masses_from_2 largest_fraction; do
  expect 0 "$clast" map many.db wide.png -x strain -y angle -Q $of --keep-script
  command=$(tr '\n' ' ' <wide.gp | sed "s/'\.\"[^ ]*\"\.'/ /g; s/.*, .clast \([a-z]*\). has all.*/\1/")
  expect 0 "$clast" "$command" many.db $([ "$command" != stats ] || echo --by strain,angle --quantity $of) --json
  python - "$of" "$(grep -o '± [0-9.e+-]*[0-9]' wide.gp | head -1)" <<'PY' || fail "widest interval of $of"
import json, sys
name = 'largest_fraction_hw95' if sys.argv[1][0] == 'l' else 'beta_masses_hw95'
rows = [r for r in json.load(open('out')) if r.get('window', 'from_2') == 'from_2' and not (name[0] == 'b' and r['beta_masses_untold'])]
widest, told = max(r[name] for r in rows), float(sys.argv[2][2:])
assert widest * (1 - 1e-9) <= told < 1.1 * widest, (widest, told)
PY
done
expect 64 "$clast" plot small.db m.png -x strain -Q beta
says "several points have strain = 2 %, and their exponents are not averaged: separate them by --by angle"
expect 64 "$clast" plot small.db m.png -x strain --by angle -Q beta_ks_from_2
says "beta_METHOD_WINDOW"
# Without axes: the first varied inputs, and the quantity of the campaign.
expect 0 "$clast" plot small.db first.svg
says "drawn over the first inputs that were varied: --x strain --by angle"
expect 0 "$clast" map small.db first_map.svg
says "varied: --x strain --y angle"
expect 0 "$clast" plot small.db m.svg --by angle
says "first other inputs that were varied: --x strain"
expect 0 "$clast" map small.db m.svg --y threshold.strain
says "first other inputs that were varied: --x angle"
# One run a point has no interval; one that ends with the range is told by its ends.
expect 0 "$clast" plot small.db one.svg -x strain --by angle --where 'replicate < 1' --keep-script
grep -q 'No error bars: no point has two runs that differ' one.gp || fail "error bars of one run"
# An axis that nobody named is an input of all points: of two scenes in one store, none of one scene alone. Lines and panels
# have few values.
two_scenes scenes.db
expect 0 "$clast" estimates scenes.db --csv # two scenes are told apart, as in the table for people
same "$(python -c 'import csv; print(*sorted({(r["scene"], r["charge_energy"] != "") for r in csv.DictReader(open("out"))}))')" "('disc-collision', False) ('disc-explosion', True)" "scenes of points"
expect 64 "$clast" map scenes.db m.png
says "no two varied inputs have numbers in all points: name two with -x and -y, and the points that have both are drawn:"
expect 0 "$clast" map scenes.db scenes.svg -x energy -y diameter
expect 64 "$clast" map scenes.db m.png -x energy -y speed
says "take two inputs that the same points have"
expect 0 "$clast" plot scenes.db scenes.svg
says "varied and suit all points: --x diameter --by scene"
# The intervals are those of what is drawn or printed: of a mark or row of one point over seeds, also where others pool.
expect 0 "$clast" plot scenes.db one.svg -x energy --by diameter
says "largest_fraction: intervals are over seeds (95 %"
grep -q 'intervals over seeds;' one.svg && ! grep -q speed one.svg || fail "what no mark pools"
expect 0 "$clast" plot scenes.db some.svg -x diameter --by scene --where 'charge_energy IS NULL OR charge_energy < 1500 OR body_diameter < 0.075'
says "intervals are over points and seeds, of one point over seeds (95 %"
sed 's/<[^>]*>//g' some.svg | tr -s '[:space:]' ' ' | grep -q 'of a mark of one point: over seeds' || fail "a mark of one point"
expect 0 "$clast" stats scenes.db --by diameter,scene --where 'charge_energy IS NULL OR charge_energy < 1500 OR body_diameter < 0.075'
says "mean and scatter are over points, not over runs; the interval is over points and seeds; in a row of one point, its runs"
expect 0 "$clast" stats scenes.db --by diameter,scene
says "mean and scatter are over points, not over runs; the interval is over points and seeds clast"
tiny nine
sed -i 's/, charge.energy: 2 kJ.m//; s/per_point: 3/per_point: 1/; s/threshold.strain: .*/threshold.strain: [2 %, 3 %, 4 %, 5 %, 6 %, 7 %, 8 %, 9 %, 10 %]/; s/^vary:/vary:\n  charge.energy: [1 kJ\/m, 2 kJ\/m]/' nine.yaml
expect 0 "$clast" run nine.yaml --quiet
expect 0 "$clast" plot nine.db nine.svg
says "varied and suit all points: --x energy --by angle"
expect 0 "$clast" map nine.db nine.svg
says "varied: --x energy --y strain --by angle"
expect 0 "$clast" map nine.db nine.svg --where 'threshold_angle < 0.05'
says "varied: --x energy --y strain"
printf 'name: lone\nscene: disc-explosion\nset: {body.diameter: 5 cm}\nquantity: fragment_count\nseeds: 3\n' >lone.yaml
expect 0 "$clast" run lone.yaml --quiet
expect 64 "$clast" plot lone.db m.png
says "no input was varied"
expect 0 "$clast" stats lone.db --csv
prints "fragment_count_mean"
expect 0 "$clast" scatter lone.db
says "values of fragment_count"
expect 0 "$clast" compare lone.db:1 lone.db:1
says "fragment_count: means, and b minus a"
expect 64 "$clast" plot small.db m.png -x strain --by strain
expect 64 "$clast" plot small.db m.png -x strain,angle
expect 64 "$clast" plot small.db m.png -x strain -Q largest_fraction,dust_fraction
says "one quantity"
expect 64 "$clast" plot small.db m.png -x strain -Q largest_share
says "'largest_share' is unknown. Similar are: largest_fraction,"
expect 64 "$clast" plot small.db m.jpg -x strain
expect 74 "$clast" plot small.db no/such/folder/m.png -x strain

expect 64 "$clast" map small.db m.png -x strain -y strain
expect 64 "$clast" map small.db m.png -x strain -y nothing
says "threshold.angle"
expect 64 "$clast" map small.db m.jpg -x strain -y angle
says ".png, .svg or .pdf"
expect 74 "$clast" map small.db no/such/folder/m.png -x strain -y angle
says "no/such/folder/m.png"
expect 66 "$clast" map none.db m.png -x strain -y angle
[ ! -e m.png ] && [ ! -e m.jpg ] || fail "a picture was left behind"
ok "nothing was left behind"

expect 0 "$clast" simulate disc-explosion --seed 3 --set 'body.diameter=8 cm' --set 'stop.end_time=1 ms' --fields disc.h5
expect 0 "$clast" picture disc.h5 own.png
expect 0 "$clast" picture disc.h5 disc.png --caption "disc (disc-explosion): seed 3, 1 ms"
is_png disc.png
cmp -s own.png disc.png || fail "the title of a picture of a file"
expect 66 "$clast" picture none.h5 none.png
echo "not HDF5" >text.h5
expect 65 "$clast" picture text.h5 none.png
says "text.h5"
head -c 3000 disc.h5 >cut.h5
expect 65 "$clast" picture cut.h5 none.png
[ ! -e none.png ] || fail "a picture was left behind"
[ -z "$(find . -name '*.part' -o -name '*.png.*' -o -name '*.svg.*')" ] || fail "a .part file was left behind"

# A kept script draws the same chart again, from its own folder, after a change by the user.
mkdir kept
expect 0 "$clast" map small.db kept/map.svg -x strain -y angle --keep-script
cp kept/map.svg first.svg
sed -i "s/^title_text = .*/title_text = 'mine'/" kept/map.gp
(cd kept && gnuplot map.gp) || fail "the kept script does not run"
grep -q mine kept/map.svg || fail "the changed title is not drawn"
same "$(grep -c '<path' kept/map.svg)" "$(grep -c '<path' first.svg)" "shapes of the chart drawn again"
expect 66 env PATH=/nowhere "$clast" plot small.db m.png -x strain
says "apt-get install gnuplot-nox"
expect 0 env PATH=/nowhere "$clast" spectrum small.db --point 1 # rows need none
expect 0 "$clast" picture disc.h5 disc.pdf
same "$(head -c 4 disc.pdf)" "%PDF" "a PDF"

# Points, campaigns and stores side by side: the difference is the table's own, with pairs of seeds.
expect 0 "$clast" compare small.db:1 small.db:4 --csv
python - <<'PY'
import csv, sqlite3
row, = csv.DictReader(open('out'))
db = sqlite3.connect('file:small.db?mode=ro', uri=True)
values = [dict(db.execute('select seed, largest_fraction from run where counts and point_id = ?', (p,))) for p in (1, 4)]
mean = sum(values[1][s] - values[0][s] for s in values[0]) / 3
assert row['pairs'] == '3' and abs(float(row['difference']) - mean) < 1e-12, (row, mean)
PY
expect 0 "$clast" compare small.db small.db:small --csv
[ "$(grep -c . out)" -eq 5 ] || fail "four points beside themselves are four rows"
[ "$(cut -d, -f1 out | tr -d '\n')" = point_a1234 ] || fail "the pairs are not in the order of their points"
expect 0 env COLUMNS=60 "$clast" compare small.db:1 small.db:4
prints "b: strain" # what differs, in the campaign's units
prints "difference" # the answer stays on a narrow screen
expect 64 "$clast" stats small.db --by threshold # a section with both inputs
says "it may be threshold.angle, threshold.strain"
expect 64 "$clast" compare small.db:1 small.db
expect 64 "$clast" compare small.db:none small.db
says "no campaign 'none'"
expect 66 "$clast" compare none.db small.db

# Scatter over seeds.
expect 0 "$clast" scatter small.db --point 2 --half-width 0.02 --csv
python - <<'PY'
import csv, sqlite3, statistics
rows = {r["statistic"]: r for r in csv.DictReader(open("out"))}
values = [v for (v,) in sqlite3.connect("small.db").execute("select largest_fraction from run where counts and point_id = 2")]
for name, truth in (("mean", statistics.mean(values)), ("standard deviation", statistics.stdev(values)), ("median", statistics.median(values))):
    assert abs(float(rows[name]["value"]) / truth - 1) < 1e-12, name
assert float(rows["runs needed"]["value"]) >= 2 and rows["runs"]["value"] == "3"
PY
ok "statistics of the scatter"
expect 0 "$clast" scatter small.db --picture scatter.svg -Q fragment_count
is_svg scatter.svg
expect 64 "$clast" scatter small.db --half-width none
expect 0 "$clast" scatter small.db --point 2 --half-width '5 %' --csv
python - <<'PY'
import csv, math
rows = {r["statistic"]: r for r in csv.DictReader(open("out"))}
wanted = 0.05 * float(rows["mean"]["value"]) # Student's t is at least 1.96
assert float(rows["runs needed"]["value"]) >= (1.96 * float(rows["standard deviation"]["value"]) / wanted) ** 2, rows
assert float(rows["runs needed, seeds.until"]["value"]) % 10 == 0, rows # prefixes of 30, 40, ... runs
PY
expect 64 "$clast" scatter small.db -Q nothing

# The four names of an exponent, and the goodness of its fit.
expect 0 "$clast" exponents small.db --draws 200 --json
python - <<'PY'
import json
for r in json.load(open("out")):
    assert r["from"] >= r["complete_mass"] > 0, r # never below the mass from which the spectrum is complete
    if r["F(m)"] is not None:
        assert abs(r["N(>m)"] - (r["F(m)"] - 1)) < 1e-12 and abs(r["N(>L)"] - 2 * r["N(>m)"]) < 1e-12, r # in the plane
        assert abs(r["F(L)"] - r["N(>L)"] - 1) < 1e-12 and 0 < r["p"] <= 1 and 0 < r["distance"] < 1, r
PY
ok "exponents by their names"
# A sample: no line joins points between which other inputs change, too; a grid has lines.
tiny sampled
sed -i 's/\[2 %, 5 %\]/{uniform: [2 %, 5 %]}/; s/\[2 deg, 6 deg\]/{uniform: [2 deg, 6 deg]}/' sampled.yaml
printf 'design: {kind: latin_hypercube, points: 32}\n' >>sampled.yaml
expect 0 "$clast" run sampled.yaml -j 2 --quiet
expect 0 "$clast" plot sampled.db sampled.png -x strain --keep-script
says "no line joins the points"
same "$(sed '/^$/,$d' sampled.dat | grep -c '^NaN')" 32 "gaps between the points of a sample"
expect 0 "$clast" map sampled.db sampled.svg -x strain -y angle --keep-script # too many marks for numbers
same "$(grep -o '>~' sampled.svg | wc -l)" "$(sed -n 's/.*; ~, \([0-9]*\) of 32: weak.*/\1/p' sampled.gp)" "weak marks"
expect 0 "$clast" plot small.db grid.png -x strain --by angle --keep-script
grep -q "^title_text = '[^:]*, disc-explosion: " grid.gp sampled.gp || fail "a title without the scene"
same "$(sed '/^$/,$d' grid.dat | grep -c '^NaN' || true)" 0 "gaps between the points of a grid"
# Two campaigns in one store: from point to point the body changes, too, and chart and table say so.
tiny second
sed -i 's/diameter: 8 cm/diameter: 6 cm/; s/strain: .*/strain: [3 %, 4 %]/' second.yaml
expect 0 "$clast" run second.yaml -j 2 --quiet
expect 0 "$clast" merge both.db small.db second.db
expect 0 "$clast" plot both.db both.png -x strain
says "from one to the next diameter of the body changes, too"
expect 0 "$clast" map both.db both-map.png -x strain -y angle
says "clast: from one to the next diameter of the body changes, too"
expect 0 "$clast" stats both.db --by strain
says "from row to row the value of body.diameter changes, too"
expect 0 "$clast" stats both.db --by strain,diameter
grep -q "from row to row" err && fail "a change that is none"
expect 0 "$clast" stats small.db --by strain
grep -q "from row to row" err && fail "a change that is none"
expect 66 "$clast" merge new.db small.db nosuch.db
[ ! -e new.db ] || fail "a failed merge left a store behind"
ok "two campaigns in one store"
# Words have no place on a map.
tiny laws
sed -i 's/threshold.angle: .*/contact.law: [conservative, printed]/' laws.yaml
expect 0 "$clast" run laws.yaml -j 2 --quiet
expect 64 "$clast" map laws.db laws.png -x contact.law -y strain
says "the values of contact.law are words"; says "\`clast plot\` draws words, with -x contact.law --by strain"
done_after 160
