#!/usr/bin/env bash
# `clast check` sees an edit of any column of any table and the loss of any row; stores without the digests stay readable.
. "$(dirname "$0")/lib.bash"

tiny edited
expect 0 "$clast" run edited.yaml -j 2
expect 0 "$clast" converge disc-explosion --set body.diameter='8 cm' --set stop.end_time='0.5 ms' \
  --knob grains=2cm,1.4cm,1cm --seeds 3 --within off --store edited.db -j 2
tiny hopeless 'limits: {time: 1 ms, attempts: 1, failures: 0}'
sed -i 's/1 ms}$/50 ms}/; s/8 cm/30 cm/; s/hopeless.db/edited.db/' hopeless.yaml
expect 1 "$clast" run hopeless.yaml -j 2
expect 0 "$clast" check edited.db
[ "$(number edited.db "select count(*) from attempt")" -gt 2 ] || fail "no attempts"
[ "$(number edited.db "select count(*) from resolution where half_width > 0")" -gt 0 ] || fail "no study"
cat >columns.py <<'PY'
import collections, shutil, sqlite3, subprocess, sys
# Words that explain a column, and who writes the store: no answer.
FREE = {('column_doc', c) for c in 'table_name column_name meaning deterministic row'.split()} | {('holder', 'row')}
# A line of check begins with the run or point of the changed row, or with the table. Not so here; None: it has no such line.
SAID = {'point_total': 'running sums:', 'point_spectrum': 'running sums:', 'column_doc': None, 'table_digest': None}
HIDES = {('axis', 'path'), ('axis', 'column_name'), ('run', 'run_id'), ('point', 'point_id')} # lines of other changes
store = sqlite3.connect('edited.db')
store.execute('pragma ignore_check_constraints = on')
tables = [t for t, in store.execute("select name from sqlite_schema where type = 'table'")]
columns = [(t, c[1], c[2]) for t in tables for c in store.execute(f'pragma table_info("{t}")')
           if store.execute(f'select count("{c[1]}") from "{t}"').fetchone()[0]]
Change = collections.namedtuple('Change', 'table what said sql values') # said: how the line of check begins that tells of it

def check(changes):
    """Makes the changes in a copy. The exit code of check, and its lines."""
    shutil.copy('edited.db', 'other.db')
    other = sqlite3.connect('other.db')
    other.execute('pragma ignore_check_constraints = on')
    other.execute('pragma synchronous = off')
    for change in changes:
        assert other.execute(change.sql, change.values).rowcount > 0, change
    other.commit()
    other.close()
    run = subprocess.run([sys.argv[1], 'check', 'other.db'], capture_output=True, text=True)
    assert run.returncode in (0, 65), (changes, run)
    return run.returncode, run.stdout.splitlines()

def changes_a_row(change):
    rows = store.execute(change.sql, change.values).rowcount
    store.rollback()
    return rows > 0

def changes_of(table, begin):
    """Of each column that has values, of some rows, and of all rows. Where runs or points have digests: of one row each."""
    names = [c[1] for c in store.execute(f'pragma table_info("{table}")')]
    rows = store.execute(f'select * from "{table}"').fetchall()
    whole = table in SAID or store.execute('select 1 from table_digest where table_name = ?', (table,)).fetchone()
    owner = next((o for o in (table, 'run_id', 'point_id') if o in names and not whole), None)

    def said(row):
        return f'{owner.removesuffix("_id")} {row[names.index(owner)]}' if owner else SAID.get(table, f'table {table}:')
    for column, kind in [c[1:] for c in columns if c[0] == table]:
        values = {'INTEGER': ('{} + 100000', '1 - {}'), 'REAL': ('{} * 1.001 + 1e-3',), 'BLOB': ('randomblob(16)',)}
        known = [row for row in rows if row[names.index(column)] is not None]
        begin = (begin + 1) % len(known) # another row for each column
        yield next(filter(changes_a_row, (
            Change(table, column, None if (table, column) in HIDES else said(row),
                   f'update or ignore "{table}" set "{column}" = {value.format(chr(34) + column + chr(34))} where '
                   f'"{column}" is not null' + (f' and {owner} = {row[names.index(owner)]}' if owner else ''), ())
            for row in known[begin:] + known[:begin] for value in values.get(kind, ("{} || 'x'",)))))
    for k in sorted({0, len(rows) // 2, len(rows) - 1} if rows else ()):
        yield Change(table, 'row', said(rows[k]), f'delete from "{table}" where ' +
                     ' and '.join(f'"{name}" is ?' for name in names), rows[k])
    if rows:
        yield Change(table, 'row', said(rows[0]), f'delete from "{table}"', ())

# Many changes in one copy, each with a line of its own. What no line tells of is tried alone.
changes = [change for number, table in enumerate(tables) for change in changes_of(table, number)]
copies, alone, missed = [], [change for change in changes if not change.said], set()
for change in changes:
    fits = (copy for copy in copies if all(c.said != change.said and (c.table != change.table or c.what != 'row') for c in copy))
    if change.said:
        copy = next(fits, None) or copies.append([]) or copies[-1]
        copy.append(change)
for copy in copies:
    lines = check(copy)[1]
    alone += [change for change in copy if not any(line.startswith(change.said) for line in lines)]
for change in alone:
    if check([change])[0] == 0 and (change.table, change.what) not in FREE:
        missed.add(f'{change.table}.{change.what}')
print(len(columns), 'columns,', len(changes), 'changes tried in', len(copies), 'copies,', len(alone), 'more alone')
assert not missed, sorted(missed)
assert len(changes) > 200, len(changes)
PY
expect 0 python columns.py "$clast"
cat out

# Each row of an exponent of a point and of a study; edges of bins; a unit.
edit() {
  cp edited.db other.db
  python -c "
import sqlite3
db = sqlite3.connect('other.db')
assert db.execute(\"$1\").rowcount == 1
db.commit()"
  expect 65 "$clast" check other.db
  prints "$2"
}
edit "update point_estimate set beta = beta * (1 + 2.3e-16) where point_id = 1 and ordinal = 3" "table point_estimate: a bit of its rows has changed"
edit "update convergence set resolution = resolution / 100 where level = 0 and quantity = 'largest_fraction'" "table convergence: a bit of its rows has changed"
edit "update convergence_limit set verdict = 'order' where quantity = 'largest_fraction'" "table convergence_limit: a bit of its rows has changed"
edit "update point_input set path = path || char(0) || 'x' where point_id = 1 and path = 'threshold.angle'" "point 1: a bit of its scene or inputs has changed"
edit "delete from attempt where attempt_id = 2" "table attempt: 12 rows were stored, and 11 are there"
edit "delete from table_digest where table_name = 'axis'" "table axis: no number of rows were stored, and $(number edited.db 'select count(*) from axis') are there"
edit "update bin set upper = upper * (1 + 2.3e-16) where bin = (select min(bin) from bin)" "its edges"
edit "update column_doc set unit = 'g' where table_name = 'points' and unit = 'kg/m' and column_name = 'mean_fragment_mass_mean'" "its unit is g, not kg/m"

# A store of a program without these digests.
cp edited.db older.db
python -c "
import sqlite3
db = sqlite3.connect('older.db')
db.execute('drop table table_digest')
db.execute('alter table run drop column fields_digest')
db.execute(\"delete from column_doc where column_name = 'fields_digest' or table_name = 'table_digest'\")
db.execute('pragma user_version = 3')
db.commit()"
expect 0 "$clast" check older.db
for question in "select * from points" "select * from estimates" "select * from resolution"; do
  "$clast" query edited.db "$question" --csv >left.csv
  "$clast" query older.db "$question" --csv | cmp -s - left.csv || fail "other answers of the older store: $question"
done
ok "the older store gives the same answers"
expect 0 "$clast" merge merged.db older.db
expect 0 "$clast" check merged.db
sed -i 's/per_point: 3/per_point: 4/' edited.yaml
expect 0 "$clast" run edited.yaml --store older.db -j 2
expect 0 "$clast" check older.db
same "$(number older.db "select row_count = (select count(*) from run) from table_digest where table_name = 'run'")" 1 "digests from now on"
done_after 20
