#!/usr/bin/env bash
# `clast check` sees an edit of any column of a store that answers come from; stores without the digests stay readable.
. "$(dirname "$0")/lib.bash"

tiny edited
expect 0 "$clast" run edited.yaml -j 2
expect 0 "$clast" converge disc-explosion --set body.diameter='8 cm' --set stop.end_time='0.5 ms' \
  --knob grains=2cm,1.4cm,1cm --seeds 3 --within off --store edited.db -j 2
expect 0 "$clast" check edited.db
[ "$(number edited.db "select count(*) from resolution where half_width > 0")" -gt 0 ] || fail "no study"
cat >columns.py <<'PY'
import shutil, sqlite3, subprocess, sys
# Facts of a session, a machine or a name: no result follows from them.
FREE = {('run', c) for c in 'attempt wall_time cpu_time peak_memory host rank finished_at'.split()}
FREE |= {('session', c) for c in 'started_at ended_at outcome host pid facts campaign_id'.split()}
FREE |= {('campaign', c) for c in 'name document plan added_at'.split()}
FREE |= {('axis', 'written_unit'), ('axis', 'meaning'), ('column_doc', 'meaning'), ('column_doc', 'deterministic')}
store = sqlite3.connect('edited.db')
tables = [t for t, in store.execute("select name from sqlite_schema where type = 'table'")]
columns = [(t, c[1], c[2]) for t in tables for c in store.execute(f'pragma table_info("{t}")')
           if store.execute(f'select count("{c[1]}") from "{t}"').fetchone()[0]]
seen, missed = 0, []
for table, column, kind in columns:
    changes = {'INTEGER': ('{} + 100000', '1 - {}'), 'REAL': ('{} * 1.001 + 1e-3',), 'BLOB': ('randomblob(16)',)}
    shutil.copy('edited.db', 'other.db')
    other = sqlite3.connect('other.db')
    other.execute('pragma ignore_check_constraints = on')
    for change in changes.get(kind, ("{} || 'x'",)):
        value = change.format(f'"{column}"')
        other.execute(f'update or ignore "{table}" set "{column}" = {value} where "{column}" is not null')
        if other.total_changes:
            break
    assert other.total_changes, (table, column)
    other.commit()
    other.close()
    code = subprocess.run([sys.argv[1], 'check', 'other.db'], capture_output=True).returncode
    assert code in (0, 65), (table, column, code)
    seen += code == 65
    if code == 0 and (table, column) not in FREE:
        missed.append(f'{table}.{column}')
print(len(columns), 'columns,', seen, 'edits seen')
assert not missed, missed
assert seen > 100, seen
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
edit "update point_estimate set beta = beta * (1 + 2.3e-16) where point_id = 1 and ordinal = 3" "the exponents of all its runs"
edit "update convergence set resolution = resolution / 100 where level = 0 and quantity = 'largest_fraction'" "its studies of convergence"
edit "update convergence_limit set verdict = 'order' where quantity = 'largest_fraction'" "its studies of convergence"
edit "update bin set upper = upper * (1 + 2.3e-16) where bin = (select min(bin) from bin)" "its edges"
edit "update column_doc set unit = 'g' where table_name = 'points' and unit = 'kg' and column_name = 'mean_fragment_mass_mean'" "its unit is g, not kg"

# A store of a program without these digests.
cp edited.db older.db
python -c "
import sqlite3
db = sqlite3.connect('older.db')
for table in ('point_estimate', 'convergence', 'convergence_limit'):
    db.execute(f'alter table {table} drop column digest')
db.execute('alter table run drop column fields_digest')
db.execute(\"delete from column_doc where column_name = 'fields_digest' or (column_name = 'digest' and table_name not in ('run', 'point'))\")
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
same "$(number older.db "select count(*) > 0 from point_estimate where digest is not null")" 1 "digests of new exponents"
done_after 16
