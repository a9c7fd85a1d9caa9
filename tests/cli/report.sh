# The page of `clast report`: how it is made here, what it shows in report.py (headless Chromium; not under sanitizers,
# where the page is the same).
. "$(dirname "$0")/lib.bash"

tiny small "keep: {fields: extremes}"
sed -i "s|^name: .*|name: \"</script><img src=x onerror=hacked=1>\\\\\"'\&<b>\"|" small.yaml
expect 0 "$clast" run small.yaml -j 2 --quiet
expect 0 "$clast" report small.db
says "small.html written"
[ "$(stat -c %s small.html)" -lt 2000000 ] || fail "a page of 12 runs is larger than 2 MB"
grep -q '<img src=x' small.html && fail "a name of the store is HTML in the page"
grep -qE '(src|href)="?(https?:)?//' small.html && fail "the page names a file of a network"
grep -q "default-src 'none'" small.html || fail "the page has no security policy"
ok "a small page of its own"

# A page is HTML; a point or a campaign of a store is named as for `clast compare`.
expect 64 "$clast" report small.db -o page.pdf
says "page.pdf: the page is HTML"
[ ! -e page.pdf ] || fail "HTML in a file of another ending"
expect 0 "$clast" report small.db:1 small.db:4 -o pair.html
expect 64 "$clast" report small.db:9
# A page replaces no page of another store or of a part of one.
mkdir one other
cp small.db one/twin.db
cp small.db other/twin.db
cp small.db twin@1.db
expect 0 "$clast" report one/twin.db
expect 74 "$clast" report other/twin.db
says "twin.html is the page of another store: name this one with -o"
expect 0 "$clast" report other/twin.db -o other/twin.html
(cd other && expect 0 "$clast" report twin.db) # the same page, from its folder
expect 0 "$clast" report "$PWD/one/twin.db" small.db # the same store by another name
expect 0 "$clast" report other/twin.db:1
expect 74 "$clast" report twin@1.db
expect 66 "$clast" report none.db:1

expect 66 "$clast" report none.db
expect 74 "$clast" report small.db -o small.db
says "it is a store"
expect 64 "$clast" report
expect 74 "$clast" report small.db -o no/such/folder/page.html
echo text >text.db
expect 65 "$clast" report text.db
[ ! -e text.html ] || fail "a page of no store was left behind"
mkdir alone
cp "$clast" alone/
expect 66 alone/clast report small.db
says "apt-get install nodejs npm"

# The page opens on the quantity of the campaign.
tiny fits "keep: {fields: first 1}"
sed -i 's/per_point: 3/per_point: 20/; $a quantity: fragment_count' fits.yaml
expect 0 "$clast" run fits.yaml -j 2 --quiet
expect 0 "$clast" report fits.db
python - <<'PY'
import base64, gzip, re, sqlite3
(text,) = re.findall(r'class="store">([^<]*)<', open('fits.html').read())
db = sqlite3.connect(':memory:')
db.deserialize(gzip.decompress(base64.b64decode(text)))
assert db.execute("select value from fact where name = 'default_quantity'").fetchone() == ('fragment_count',)
PY
ok "the main quantity"

# Every kept field file is a picture of its run, also of a run that is no median. Units are those of the engine's results.
python - <<'PY'
import base64, gzip, re, sqlite3
(text,) = re.findall(r'class="store">([^<]*)<', open('fits.html').read())
page = sqlite3.connect(':memory:')
page.deserialize(gzip.decompress(base64.b64decode(text)))
store = sqlite3.connect('file:fits.db?mode=ro', uri=True)
kept = sorted(store.execute('select run_id, point_id from run where fields_path is not null'))
drawn = page.execute('select run_id, point_id, quantile from picture order by 1').fetchall()
assert [row[:2] for row in drawn] == kept and len(kept) == 4 and None in (row[2] for row in drawn), (drawn, kept)
units = store.execute("select column_name, unit from column_doc where table_name = 'runs' and unit like 'J%'").fetchall()
labels = dict(page.execute('select column_name, unit from label'))
assert labels['energy_input'] == 'J/m' and {c: labels[c] for c, _ in units if c in labels} == {c: u for c, u in units if c in labels}, labels
PY
ok "pictures of all kept fields, units of results"

# The exponents of the page, and of a whole store on it, are those of the table for people, with its reasons.
for store in fits small; do
  expect 0 "$clast" estimates $store.db --json
  node --input-type=module - "$source/analysis/report/questions.js" <<'JS' >sql.json
const {exponents} = await import(process.argv[2]);
console.log(JSON.stringify([exponents(true), exponents(true), exponents(false)]));
JS
  python - $store <<'PY' || fail "$store: other exponents on the page"
import base64, gzip, json, re, sqlite3, sys
(text,) = re.findall(r'class="store">([^<]*)<', open(f'{sys.argv[1]}.html').read())
page = sqlite3.connect(':memory:')
page.deserialize(gzip.decompress(base64.b64decode(text)))
rows = {r['point_id']: r for r in json.load(open('out')) if r['window'] == 'from_5'}
assert rows and {r['beta_masses_untold'] == '' for r in rows.values()} == ({True, False} if sys.argv[1] == 'fits' else {False}), rows
whole = sqlite3.connect(f'file:{sys.argv[1]}.db?mode=ro', uri=True)
for k, (db, sql) in enumerate(zip((page, whole, whole), json.load(open('sql.json')))):
    cursor = db.execute(sql)
    for row in (dict(zip([c[0] for c in cursor.description], r)) for r in cursor):
        want = rows[row['point_id']]
        unknown = k == 2 and row['untold'] == 'no interval' and want['beta_masses_hw95'] is None # no fragments of runs there
        assert row['mean'] == want['beta_masses'] and (unknown or (row['untold'] or '') == want['beta_masses_untold']), (row, want)
PY
done
ok "the exponents that the page leaves out"

# Without the key `quantity`, the page opens on what the scene is made for, also after a study.
printf '%s\n' 'name: load' 'scene: uniaxial' 'set: {body.rows: 6, body.columns: 4}' 'seeds: 1' >load.yaml
expect 0 "$clast" run load.yaml --quiet
expect 0 "$clast" converge load.yaml --knob time_step -Q young_modulus --seeds 2 --max-seeds 2 --within off --store load.db
python - <<'PY' # a finer setting, for which a study tells an error
import sqlite3
db = sqlite3.connect('load.db')
db.execute("insert into point (hash, engine, scene_name, scene) select randomblob(16), engine, scene_name, scene from point where point_id = 1")
db.execute("insert into point_input select (select max(point_id) from point), path, value from point_input where point_id = 1")
db.commit()
PY
expect 0 "$clast" report load.db
says "left out: "
expect 0 "$clast" report load.db --studies -o studied.html
python - <<'PY'
import base64, gzip, re, sqlite3
(text,) = re.findall(r'class="store">([^<]*)<', open('load.html').read())
db = sqlite3.connect(':memory:')
db.deserialize(gzip.decompress(base64.b64decode(text)))
(quantity,) = db.execute("select value from fact where name = 'default_quantity'").fetchone()
assert quantity.endswith('young_modulus'), quantity
PY
# That setting is no point of the page, nor of a store that is dropped on it.
node --input-type=module - "$source/analysis/report/questions.js" <<'JS' >sql.json
const {points} = await import(process.argv[2]);
console.log(JSON.stringify(points([], '')));
JS
python - <<'PY' || fail "points that no campaign asked for"
import base64, gzip, json, re, sqlite3
(text,) = re.findall(r'class="store">([^<]*)<', open('studied.html').read())
page = sqlite3.connect(':memory:')
page.deserialize(gzip.decompress(base64.b64decode(text)))
store = sqlite3.connect('file:load.db?mode=ro', uri=True)
asked = {row[0] for row in store.execute('select point_id from campaign_point')}
for db in (page, store):
    assert {row[0] for row in db.execute(json.load(open('sql.json')))} == asked, asked
PY
ok "what the scene is made for"

# The page makes intervals as the program does: of shares and of counts, of 20 and of 3 runs, and of equal runs.
for store in fits small; do
  expect 0 "$clast" query $store.db --json "select 1 as share, n, largest_fraction_mean as mean, largest_fraction_sd as sd,
    largest_fraction_hw95 as hw95, largest_fraction_low95 as low95, largest_fraction_high95 as high95, largest_fraction_weak
    as weak from points union all select 1, n, 1.0, 0.0, null, pow(0.05, 1.0 / n), 1.0, null from points union all
    select 0, n, fragment_count_mean, fragment_count_sd, fragment_count_hw95, fragment_count_low95, fragment_count_high95,
    null from points"
  node --input-type=module - "$source/analysis/report/statistics.js" <<'JS' || fail "$store: other intervals on the page"
import {readFileSync} from 'node:fs';
const {interval} = await import(process.argv[2]);
const rows = JSON.parse(readFileSync('out', 'utf8'));
for (const {share, n, mean, sd, ...want} of rows)
  for (const [name, value] of Object.entries(interval(mean, sd, n, {share, least: 0})))
    if (want[name] === null ? value !== null : !(Math.abs(value - want[name]) <= 1e-9 * Math.abs(want[name])))
      throw new Error(`${name}: ${value}, not ${want[name]} (${JSON.stringify({share, n, mean, sd})})`);
if (rows.length !== 12) throw new Error(`${rows.length} rows`);
JS
  # Their digits are those of the tables.
  expect 0 "$clast" stats $store.db --by angle,strain -Q largest_fraction,fragment_count,mean_fragment_mass,wall_time --json
  cp out rows.json
  expect 0 "$clast" stats $store.db --by angle,strain -Q largest_fraction,fragment_count,mean_fragment_mass,wall_time
  node --input-type=module - "$source/analysis/report/words.js" <<'JS' || fail "$store: other digits on the page"
import {readFileSync} from 'node:fs';
const {withInterval} = await import(process.argv[2]);
const table = readFileSync('out', 'utf8');
for (const row of JSON.parse(readFileSync('rows.json', 'utf8')))
  for (const name of ['largest_fraction', 'fragment_count', 'mean_fragment_mass', 'wall_time']) {
    const of = (what) => row[`${name}_${what}`] ?? null;
    const shown = withInterval({mean: of('mean'), hw95: of('hw95'), low95: of('low95'), high95: of('high95')});
    if (!table.includes(` ${shown}`)) throw new Error(`${name}: the table has no ${shown}`);
  }
JS
  # So are intervals of quantiles of any result, as of `clast scatter`.
  expect 0 "$clast" scatter $store.db -Q mean_fragment_mass --json
  "$clast" query $store.db --json "SELECT point_id, mean_fragment_mass AS value FROM runs WHERE counts" >rows.json 2>err
  node --input-type=module - "$source/analysis/report/statistics.js" <<'JS' || fail "$store: other quantiles on the page"
import {readFileSync} from 'node:fs';
const {quantile, quantileInterval} = await import(process.argv[2]);
const runs = JSON.parse(readFileSync('rows.json', 'utf8')), share = {q05: 0.05, q25: 0.25, median: 0.5, q75: 0.75, q95: 0.95};
let known = 0;
for (const {point_id, statistic, value, low, high} of JSON.parse(readFileSync('out', 'utf8')).filter((row) => row.statistic in share)) {
  const sorted = runs.filter((run) => run.point_id === point_id).map((run) => run.value).sort((a, b) => a - b);
  const own = {value: quantile(sorted, share[statistic]), ...quantileInterval(sorted, share[statistic])};
  if (Math.abs(own.value - value) > 1e-9 * value || own.low !== low || own.high !== high) throw new Error(JSON.stringify({point_id, statistic, value, low, high, own}));
  known += low !== null && high !== null;
}
if (known !== (runs.length > 12 ? 12 : 0)) throw new Error(`${known} intervals`);
JS
done
ok "intervals"

# A page that is made again while a campaign runs, and a last time when it ends.
slow watched
"$clast" run watched.yaml -j 1 --quiet >/dev/null 2>&1 &
campaign=$!
for _ in $(seq 100); do ! "$clast" status watched.db >/dev/null 2>&1 || break; sleep 0.05; done
expect 0 "$clast" report watched.db --watch --every 1
wait "$campaign" || fail "the watched campaign failed"
[ "$(grep -c 'while the campaign runs' err)" -ge 1 ] || fail "the page was not made while the campaign ran"
expect 0 "$clast" report watched.db -o last.html
python - <<'PY'
import base64, gzip, re, sqlite3
def data(page):
    (text,) = re.findall(r'class="store">([^<]*)<', open(page).read())
    db = sqlite3.connect(':memory:')
    db.deserialize(gzip.decompress(base64.b64decode(text)))
    return db
watched, last = data('watched.html'), data('last.html')
for question in ("select count(*) from runs", "select value from fact where name = 'refresh'"):
    a, b = (db.execute(question).fetchone() for db in (watched, last))
    assert a == b, (question, a, b)
PY
ok "the page of a watched campaign ends with all its runs"

if [ "$sanitized" -eq 0 ]; then
  command -v chromium >/dev/null || fail "chromium is missing: ./setup.sh packages installs it"
  tiny other # 8 points, too many to distinguish in one chart
  sed -i 's/energy: 2/energy: 3/; s/strain: .*/strain: [2 %, 3 %, 4 %, 5 %]/' other.yaml
  expect 0 "$clast" run other.yaml -j 2 --quiet
  expect 0 "$clast" merge both.db small.db other.db
  tiny marked # a time step near the longest stable one marks the results of half of the points
  sed -i 's/threshold.angle: .*/fidelity.time_step: [1 us, 4 us]/; s/stop.end_time: [^,}]*/stop.least_time: 1 ms/' marked.yaml
  expect 0 "$clast" run marked.yaml -j 2 --quiet
  python - <<'PY' # a study that knows no limit, a mean number of grains that differs by a part of one, and more grains
import sqlite3
other = sqlite3.connect('other.db')
other.execute('update result_dem set grains = grains + 5')
other.commit()
db = sqlite3.connect('marked.db')
db.execute("insert into convergence (base_point_id, results_version, level, point_id, knob, quantity, base, resolution, open)"
           " select point_id, max(results_version), 0, point_id, 'time_step', 'largest_fraction', 1, 0.042, 1 from run"
           " where point_id = 1")
db.execute('update result_dem set grains = grains + 1 where run_id = (select min(run_id) from run where point_id = 1)')
db.commit()
PY
  expect 0 "$clast" report marked.db
  # Two stores: an input that both hold fixed differs; and no point in common.
  expect 0 "$clast" compare small.db other.db
  says "a and b also differ in charge.energy (2000 J/m, 3000 J/m)"
  expect 0 "$clast" report small.db other.db -o two.html
  expect 0 "$clast" report small.db --campaign 1 --where 'seed < 3' -o chosen.html
  expect 0 "$clast" report small.db:4
  says "small@4.html written" # not small-4.html, the page of small-4.db
  points=$(number both.db "select group_concat('both.db:' || point_id, ' ') from points where threshold_strain < 0.021 and threshold_angle < 0.05")
  expect 0 "$clast" report $points -o energies.html
  expect 0 "$clast" report small.db:1 small.db:2 small.db:4 other.db:1 other.db:2 other.db:4 small.db:3 -o seven.html
  expect 0 "$clast" report small.db marked.db -o apart.html
  tiny held # fixes an input that small.db varies
  sed -i 's/1 ms/1 ms, threshold.angle: 6 deg/; /^  threshold.angle/d' held.yaml
  expect 0 "$clast" run held.yaml -j 2 --quiet
  expect 0 "$clast" report held.db small.db -o held.html
  # The page's own mean and standard deviation do not depend on the unit.
  echo '{"type": "module"}' >package.json
  cp "$source/analysis/report/statistics.js" .
  cat >units.js <<'JS'
import {summary} from './statistics.js';
for (const unit of [1e-300, 1e-170, 1e-100, 1e-61, 1e61, 1e100, 1e160, 1e300]) {
  const {mean, sd} = summary([1, 2, 3, 4].map((value) => value * unit));
  if (!(Math.abs(mean / unit - 2.5) < 1e-12 && Math.abs(sd / unit - Math.sqrt(5 / 3)) < 1e-12)) throw new Error(`${unit}: ${mean}, ${sd}`);
}
JS
  expect 0 node units.js
  tiny three # two points share each cell of a map
  sed -i 's/, charge.energy: 2 kJ.m//; s/^vary:/vary:\n  charge.energy: [1 kJ\/m, 2 kJ\/m]/; s/seeds: {/&independent: true, /' three.yaml
  expect 0 "$clast" run three.yaml -j 2 --quiet
  expect 0 "$clast" report three.db
  two_scenes scenes.db
  expect 0 "$clast" report scenes.db
  tiny whole "keep: {fields: extremes}"
  sed -i 's/2 %, 5 %/50 %, 60 %/; s/2 deg, 6 deg/20 deg, 60 deg/' whole.yaml
  expect 0 "$clast" run whole.yaml --quiet
  expect 0 "$clast" report whole.db
  grep -q 'marked' err && fail "marks of each picture are printed"
  expect 0 "$clast" converge block-impact --set body.columns=12 --set body.rows=8 --set stop.end_time=0.2ms --knob grains=0.02m,0.014m,0.01m --seeds 2 --within off --store levels.db --quiet
  expect 0 "$clast" report levels.db --studies
  python "$source/tests/cli/report.py" "$source/tests/support" "$clast" small.html small.db other.db marked three || fail "the page in a browser"
  ok "the page in a browser"
  done_after 68
else
  done_after 43
fi
