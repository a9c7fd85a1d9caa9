#!/usr/bin/env bash
# A tiny campaign from the first line to the last: plan, run, resume, grow; then every command that reads its store.
. "$(dirname "$0")/lib.bash"

tiny tiny
expect 0 "$clast" plan tiny.yaml
prints "threshold.strain: 2 %, 5 %"; prints "12"; [ ! -e tiny.db ] || fail "plan made a store"
expect 0 "$clast" plan tiny.yaml --no-trial --json
python -c "import json; d = json.load(open('out')); assert isinstance(d, dict) and d, d"
expect 0 "$clast" run tiny.yaml --dry-run
[ ! -e tiny.db ] || fail "a dry run made a store"

expect 0 "$clast" run tiny.yaml -j 2
says "12 runs computed"; prints "M_1/M"
for point in 1 2 3 4; do grep -qE "^ +(2|5) +(2|6) +$point  " out || fail "no line of point $point"; done
[ ! -e tiny.db-wal ] || fail "a WAL file is left after a clean end"
same "$(number tiny.db 'select count(*) from runs where counts')" 12 "runs that count"
same "$(number tiny.db 'select count(distinct threshold_strain) from points')" 2 "levels of an axis column"
"$clast" query tiny.db "select identity, largest_fraction from runs order by 1" --csv >first.csv

expect 0 "$clast" run tiny.yaml -j 2
says "0 runs computed"; says "12 found"
sed -i 's/per_point: 3/per_point: 5/' tiny.yaml
expect 0 "$clast" run tiny.yaml -j 2 --json
python -c "
import json; rows = json.load(open('out'))
assert len(rows) == 12 and all(r['n'] == 5 and r['failed'] == 0 for r in rows), rows
assert all(0 < r['largest_fraction_mean'] <= 1 for r in rows)"
ok "the table at the end as JSON"
says "8 runs computed"
# pooled exponents are in the store: six per point, computed again when runs were added, from all runs that count
pooled="from estimates where run_id is null"
same "$(number tiny.db "select count(*) $pooled group by point_id order by 1 desc limit 1")" 6 "pooled estimates of a point"
same "$(number tiny.db "select count(distinct point_id) $pooled")" 4 "points with pooled estimates"
python - <<'PY'
import json, sqlite3
rows = json.load(open('out'))
stored = {(p, w): (b, n, u) for p, w, b, n, u in sqlite3.connect('file:tiny.db?mode=ro', uri=True).execute(
    "select point_id, window, beta, n, untold from estimates where run_id is null and method = 'masses'")}
assert len(stored) == 12
for r in rows:
    b, n, u = stored[r['point_id'], r['window']]
    assert n == r['fragments'] and (u or '') == (r['beta_masses_untold'] or '') and (b is None) == (r['beta_masses'] is None), (r, b, n)
    assert b is None or abs(b - r['beta_masses']) < 0.0051, (r, b)  # printed to two decimals
PY
ok "the pooled estimates in the store are those printed"
"$clast" query tiny.db "select identity, largest_fraction from runs where replicate < 3 order by 1" --csv | cmp -s - first.csv || fail "old runs changed"
ok "growing the campaign changed no old run"
expect 0 "$clast" run tiny.yaml --quiet --csv
silent err

# table, CSV and JSON have the same contents
expect 0 "$clast" stats tiny.db --by strain,angle --quantity largest_fraction --csv; mv out stats.csv
expect 0 "$clast" stats tiny.db --by strain,angle --quantity largest_fraction --json; mv out stats.json
expect 0 "$clast" stats tiny.db --by strain,angle --quantity largest_fraction
python - <<'PY'
import csv, json
a = list(csv.DictReader(open('stats.csv', newline='')))
b = json.load(open('stats.json'))
lines = open('out', encoding='utf-8').read().splitlines()
assert len(a) == len(b) == len(lines) - 1 == 4, (len(a), len(b), len(lines))
for x, y, line in zip(a, b, lines[1:]):
    assert list(x) == list(y)
    for name, v in y.items():
        assert x[name] == '' if v is None else x[name] == v if isinstance(v, str) else float(x[name]) == float(v), (name, x, y)
    # People see varied inputs in the units of the campaign, counts, and the mean with its half width in the same digits.
    strain, angle, points, n, *_ = line.split()
    assert abs(float(strain) * 0.01 - y['threshold_strain']) < 1e-12, line
    assert abs(float(angle) * 3.14159265358979 / 180 - y['threshold_angle']) < 1e-12, line
    assert [int(points), int(n)] == [y['points'], y['n']], line
    if y['largest_fraction_hw95']:
        mean, sign, error = line.split('  ')[-1].rstrip('~ !').split()
        last = 10.0 ** -len(mean.partition('.')[2])
        assert sign == '±' and len(mean.partition('.')[2]) == len(error.partition('.')[2]), line
        assert abs(float(mean) - y['largest_fraction_mean']) <= 0.501 * last, (line, y)
        assert abs(float(error) - y['largest_fraction_hw95']) <= 0.501 * last and float(error) < 20 * last, (line, y)
PY
ok "stats: table, CSV and JSON agree"

# every canned query runs
"$clast" query --list --json >list
count=$(python - "$clast" <<'PY'
import json, subprocess, sys
queries = json.load(open("list"))
for query in queries:
    given = [word for name in query["with"].replace(",", " ").split() for word in ("--with", name + "=1")]
    json.loads(subprocess.check_output([sys.argv[1], "query", "tiny.db", "--named", query["name"], *given, "--json"]))
print(len(queries))
PY
) || fail "a canned query"
[ "$count" -ge 5 ] || fail "only $count canned queries"
ok "canned queries run: $count"

expect 0 "$clast" status tiny.db
prints "tiny"; prints "finished"
expect 0 "$clast" estimates tiny.db
expect 0 "$clast" spectrum tiny.db --point 1 --json
python -c "
import json; rows = json.load(open('out'))
assert rows and abs(sum(r['mass_share'] for r in rows) - 1) < 1e-9
assert all(r['runs'] == 5 for r in rows)"
ok "the mass shares of a spectrum sum to one"
for command in spectrum estimates; do
  expect 64 "$clast" $command tiny.db --point 999
  says "points 1 to 4"
done
expect 0 "$clast" spectrum tiny.db --where "replicate = 0" --csv
expect 0 "$clast" check tiny.db
expect 0 "$clast" replay tiny.db 3
says "agree to the last bit"
# A result that the earlier program did not have has no value in the store; the other results are compared.
# The digest of a run is a sum over its values (db/store/internal.h) and NULL adds nothing: the values are subtracted.
cp tiny.db older.db
python -c "
import sqlite3, struct
WORD = 2**64 - 1
def step(state, word):
    a = (state[0] ^ word) * 0xbf58476d1ce4e5b9 & WORD
    b = (state[1] + word) * 0x94d049bb133111eb & WORD
    return a ^ a >> 31, b ^ b >> 29
def chain(state, text):
    state = step(state, len(text))
    for i in range(0, len(text), 8):
        state = step(state, int.from_bytes(text[i:i + 8].encode(), 'little'))
    return state
db = sqlite3.connect('older.db')
column = [c[1] for c in db.execute('PRAGMA table_info(result_dem)') if c[2] == 'REAL'
          and db.execute(f'SELECT count({c[1]}) = count(*) FROM result_dem').fetchone()[0]][0]
name = chain(chain((0x9e3779b97f4a7c15, 0x6a09e667f3bcc909), 'result_dem'), column)
for run, value, digest in db.execute(f'SELECT run_id, {column}, digest FROM result_dem JOIN run USING (run_id)').fetchall():
    bits, = struct.unpack('<Q', struct.pack('<d', value + 0.0))
    added = step(step(name, 2), bits) # 2: a float64 of row 0
    rest = [sum_ - part & WORD for sum_, part in zip(struct.unpack('<QQ', digest), added)]
    db.execute('UPDATE run SET digest = ? WHERE run_id = ?', (struct.pack('<QQ', *rest), run))
db.execute(f'UPDATE result_dem SET {column} = NULL')
db.commit()
print(column)" >column
expect 0 "$clast" replay older.db 3
says "1 result not compared"
says "$(cat column)"
cp tiny.db wrong.db
python -c "
import sqlite3
db = sqlite3.connect('wrong.db')
db.execute('UPDATE result_dem SET $(cat column) = NULL WHERE run_id = 3')
db.commit()"
expect 65 "$clast" replay wrong.db 3
says "1 of"
# Another build, and another version of the results, are named.
cp tiny.db other.db
python -c "
import sqlite3
db = sqlite3.connect('other.db')
db.execute(\"UPDATE session SET facts = json_set(facts, '$.version', '0.1', '$.commit', 'abcdef')\")
db.commit()"
expect 0 "$clast" replay other.db 3
says "another build (clast 0.1, commit abcdef"
says "agree to the last bit"
python -c "
import sqlite3
db = sqlite3.connect('other.db')
db.execute('UPDATE run SET results_version = 1 WHERE run_id = 3')
db.commit()"
expect 65 "$clast" replay other.db 3
says "program of that version: clast 0.1, commit abcdef"
expect 0 "$clast" replay tiny.db 2
! grep -q "another build" err || fail "this build is called another one"
# A program without some input computed the same seeds: each counts twice.
expect 0 "$clast" stats tiny.db
says "pooled over threshold.angle, threshold.strain"
! grep -q warning err || fail "a warning of twins that are none"
python -c "
import sqlite3
db = sqlite3.connect('older.db')
new = db.execute('INSERT INTO point SELECT NULL, randomblob(16), digest, engine, scene_name, scene FROM point WHERE point_id = 1').lastrowid
db.execute('INSERT INTO point_input SELECT ?, path, value FROM point_input WHERE point_id = 1 AND path <> ?', (new, 'contact.friction'))
columns = ', '.join(c[1] for c in db.execute('PRAGMA table_info(run)') if c[1] not in ('run_id', 'point_id', 'identity'))
db.execute(f'INSERT INTO run (point_id, identity, {columns}) SELECT ?, randomblob(16), {columns} FROM run WHERE point_id = 1', (new,))
db.commit()"
expect 0 "$clast" stats older.db
says "contact.friction"
expect 64 "$clast" replay tiny.db 999
expect 64 "$clast" replay tiny.db x
expect 0 "$clast" retry tiny.db
says "nothing to try again"
expect 0 "$clast" export tiny.db hand.db
expect 0 "$clast" check hand.db
expect 74 "$clast" export tiny.db hand.db
expect 74 "$clast" export tiny.db hand.db/tables --csv
says "cannot make the folder"
expect 0 "$clast" export tiny.db tables --csv
same "$(ls tables | tr '\n' ' ')" "column_doc.csv estimates.csv points.csv resolution.csv runs.csv spectra.csv " "exported tables"
same "$(python -c "import csv; print(len(list(csv.DictReader(open('tables/runs.csv', newline='')))))")" 20 "rows of runs.csv"

# two halves from two machines make the whole
tiny half 'store: left.db'; sed -i '/^store: half/d; s/angle: \[2 deg, 6 deg\]/angle: [2 deg]/' half.yaml
expect 0 "$clast" run half.yaml --quiet
sed -i 's/\[2 deg\]/[6 deg]/; s/left/right/' half.yaml
expect 0 "$clast" run half.yaml --quiet
expect 0 "$clast" merge both.db left.db right.db
expect 0 "$clast" merge both.db right.db
says "0 runs added"
same "$(number both.db 'select count(*) from runs')" 12 "merged runs"
"$clast" query both.db "select identity, largest_fraction from runs order by 1" --csv | cmp -s - first.csv || fail "merged store differs"
ok "merged store holds the same bits"
expect 0 "$clast" check both.db

# an input whose default follows from others is an axis where a campaign chose it, not where it only follows
derived() { # derived NAME SCENE SET
  printf 'name: %s\nscene: %s\nset: {%s}\nseeds: {per_point: 1}\nstore: %s.db\n' "$1" "$2" "$3" "$1" >"$1.yaml"
  "$clast" run "$1.yaml" --quiet >out 2>err || fail "run $1"
}
axes() { number "$1" "select group_concat(path, ' ') from (select path from axis order by path)"; }
disc='body.diameter: 6 cm, stop.end_time: 0.2 ms'
derived soft disc-explosion "$disc, grain.young_modulus: 1 GPa"
derived stiff disc-explosion "$disc, grain.young_modulus: 3 GPa"
derived brisk disc-explosion "$disc, grain.young_modulus: 3 GPa, fidelity.time_step: 0.3 us"
for rock in 8 9; do derived "weibull$rock" basalt-sphere "fidelity.particles: 300, stop.end_time: 4 us, target.material.weibull.m: $rock"; done
for strain in 2 3; do derived strain$strain disc-explosion "$disc, threshold.strain: $strain %"; done
derived usual basalt-sphere "fidelity.particles: 300, stop.end_time: 4 us"
expect 0 "$clast" merge followed.db soft.db stiff.db
same "$(axes followed.db)" grain.young_modulus "axes of campaigns of other grains"
expect 0 "$clast" merge chosen.db stiff.db brisk.db
same "$(axes chosen.db)" fidelity.time_step "axes with a chosen step"
# stores of several scenes: the scene is an axis; inputs that differ are shown as people write them
expect 0 "$clast" merge 'all discs.db' strain2.db strain3.db
says "\`clast stats 'all discs.db' --campaign NAME\`"
expect 0 "$clast" merge scenes.db weibull8.db strain2.db strain3.db
expect 0 "$clast" stats scenes.db --by scene --csv
same "$(cut -d, -f1,4 out | tr '\n' ' ')" "scene,points basalt-sphere,1 disc-explosion,2 " "means by scene"
expect 0 "$clast" stats scenes.db --by threshold.strain
prints "strain [%]"
expect 0 "$clast" estimates scenes.db
prints "basalt-sphere"
expect 0 "$clast" merge rock.db weibull8.db weibull9.db
same "$(axes rock.db)" target.material.weibull.m "axes of two rocks"
expect 0 "$clast" stats rock.db --by target.material.weibull.m --csv
prints target_material_weibull_m
expect 0 "$clast" merge half.db usual.db weibull9.db
same "$(axes half.db)" target.material.weibull.m "axes of a rock beside its own"
derived weibull9 basalt-sphere "fidelity.particles: 300, stop.end_time: 4 us, target.material.weibull.m: 9"
expect 0 "$clast" run usual.yaml --store weibull9.db --quiet
says "target.material.weibull.m (9 there"
same "$(axes weibull9.db)" target.material.weibull.m "axes of a run beside a rock"

# points that end at seeds.max before the rule is met are told at the end, also with --quiet, and in the status
tiny wide 'quantity: largest_fraction'
sed -i 's/^seeds: .*/seeds: {until: {quantity: largest_fraction, half_width: 0.0001}, max: 60}/; /^store:/d' wide.yaml
echo 'store: wide.db' >>wide.yaml
sed -i 's/8 cm/6 cm/; s/1 ms/0.2 ms/' wide.yaml
expect 0 "$clast" run wide.yaml --quiet
says "warning: 4 of 4 points ended at seeds.max (60 runs) before seeds.until was met (largest_fraction to ± 0.0001). Point"
says "Raise seeds.max, or ask for less"
grep -q "narrow enough" err && fail "a wide interval is called narrow"
expect 0 "$clast" status wide.db
prints "too early"
expect 0 "$clast" status wide.db --json
prints '"rule_unmet": 4'
# A width has its unit: the runs are there, and the rule asks for another result.
sed 's/until: {.*}, max/until: {quantity: last_break, half_width: 1 ns}, max/; s/^quantity: .*/quantity: last_break/' wide.yaml >unit.yaml
expect 0 "$clast" plan unit.yaml --no-trial --store unit.db
tr -s "\n " " " <out | grep -qF "(last_break to ±1 ns; at least" || fail "a width without a unit"
expect 0 "$clast" run unit.yaml --quiet
says "before seeds.until was met (last_break to ± 1 ns)"
tr '\n' ' ' <err | grep -Eq 'its interval is ± [0-9.e+-]+ ns\. Raise' || fail "an interval without a unit: $(cat err)"
# An interval of a table can be narrow where the rule still wants more runs.
half=$(number wide.db 'select 1.2 * max(ci_half) from (select 2.0010 * sqrt((avg(x * x) - avg(x) * avg(x)) / 59) ci_half from (select point_id, largest_fraction x from run where counts) group by point_id)')
sed "s/half_width: 0.0001/half_width: $half/" wide.yaml >narrow.yaml
expect 0 "$clast" run narrow.yaml --store wide.db --quiet
says "narrow enough, but the rule takes more runs before it trusts one"
sed 's/max: 60/max: 40/' wide.yaml >short.yaml
expect 65 "$clast" plan short.yaml --no-trial
says "seeds.until ends no point before 41 runs, whatever its interval, and max is 40: give max: 41 or more, or per_point: 40"
# A share near 1 has a wider interval in tables than Student's: a point that met the rule is no wider there. Equal runs end
# it at 50, and their bound is told.
cat >near.yaml <<'YAML'
name: near
scene: disc-explosion
set: {body.diameter: 6 cm, stop.end_time: 0.1 ms}
vary: {charge.energy: [1 J/m, 520 J/m]}
seeds: {until: {half_width: 3 %}, max: 120}
YAML
expect 0 "$clast" run near.yaml -j 2 --csv
says "1 of those that met it has runs that are all equal: tables have the bounds"
expect 0 "$clast" stats near.db --by energy --csv
python - <<'PY'
import csv
equal, other = csv.DictReader(open("out"))
assert equal["n"] == "50" and float(equal["largest_fraction_low95"]) < 0.95, equal
assert float(other["largest_fraction_hw95"]) <= 0.03 * float(other["largest_fraction_mean"]), other
PY
ok "the table of a point that met the rule"
# A plan sees which points have met the rule by the runs in the store.
runs=$(number near.db "select sum(runs) from point_total")
expect 0 "$clast" plan near.yaml # nothing is left to predict, and no run is timed
prints "(from runs in the store)"
prints "runs      $runs (every point has met seeds.until or has seeds.max runs), $runs of them in the store"
sed 's/520 J/700 J/' near.yaml >far.yaml
expect 0 "$clast" plan far.yaml --no-trial --store near.db
prints "runs      100 to 170 (largest_fraction to ±3 % of its mean; at least 50 seeds a point, as few can"
prints "; 1 of 2 points have ended), 50 of them in the store"
sed -i 's/half_width: 0.0001/half_width: 50 %/' wide.yaml
expect 0 "$clast" run wide.yaml --quiet
grep -q "seeds.max" err && fail "a rule that is met is warned of"
expect 0 "$clast" status wide.db --json
prints '"rule_unmet": 0'
ok "points whose interval stays wider than asked"

# a reader that closes the pipe early is no error
{ got=0; "$clast" query tiny.db --csv "with recursive c(x) as (select 1 union all select x + 1 from c limit 300000) select x from c" 2>err || got=$?; echo "$got" >code; } | head -n 1 >/dev/null
same "$(cat code)" 0 "exit code when the reader goes away"
silent err

# statements that a query refuses
expect 64 "$clast" query tiny.db "delete from run"
expect 64 "$clast" query tiny.db "select 1; select 2"
expect 64 "$clast" query tiny.db "select nonsense"
says "nonsense"
expect 64 "$clast" query tiny.db --named elephant
expect 64 "$clast" stats tiny.db --by elephant
says "threshold.strain"
expect 64 "$clast" stats tiny.db --quantity largest_fraction,beta
says "clast estimates tiny.db"
expect 64 "$clast" query tiny.db "select :x"
says "give --with x=VALUE"
expect 0 "$clast" query tiny.db "select :x as x" --with x=3 --csv
expect 75 "$clast" query tiny.db --seconds 1 "with recursive c(x) as (select 1 union all select x + 1 from c) select max(x) from c"
done_after 94
