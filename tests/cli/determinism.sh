#!/usr/bin/env bash
# The same bits with 1, 2, 3 slots or ranks, isolated and in process, and after interruptions at random instants; the same
# command computes only what is missing; a changed campaign reuses what it can.
. "$(dirname "$0")/lib.bash"

# Every counting run by identity, with all that its engine reported, its masses, spectrum and estimates; nothing that is of
# the machine or the moment.
cat >dump.py <<'PY'
import sqlite3, sys
db = sqlite3.connect(f"file:{sys.argv[1]}?mode=ro", uri=True)
moment = {"run_id", "point_id", "session_id", "estimate_id", "attempt", "host", "rank", "wall_time", "cpu_time", "peak_memory",
          "finished_at", "fields_path"}
def rows(table, where, *values):
    cursor = db.execute(f"select * from {table} where {where}", values)
    names = [c[0] for c in cursor.description]
    return sorted(repr([(n, v.hex() if isinstance(v, (float, bytes)) else v) for n, v in zip(names, row) if n not in moment])
                  for row in cursor)
runs = db.execute("select identity, run_id from run where surplus = 0 order by identity").fetchall()
for identity, run in runs:
    print(identity.hex())
    for table in ("run", "result_dem", "fragment_mass", "spectrum", "estimate"):
        print(table, *rows(table, "run_id = ?", run), sep="\n ")
print(len(runs), "runs")
PY
dump() { python dump.py "$1" >"$1.txt"; tail -n 1 "$1.txt"; }
same_as() { cmp -s "$1.txt" "$2.txt" || { diff "$1.txt" "$2.txt" | head -20; fail "$1 and $2 differ"; }; ok "$1 and $2 hold the same bits"; }

tiny one "seeds: {per_point: 12}" && sed -i '/^seeds: {per_point: 3}/d' one.yaml
expect 0 "$clast" run one.yaml -j 1
same "$(dump one.db)" "48 runs" "one slot"
grep -q fragment_mass one.db.txt && [ "$(wc -c <one.db.txt)" -gt 100000 ] || fail "the dump holds too little to compare"
expect 0 "$clast" run one.yaml -j 2 --store two.db
expect 0 "$clast" run one.yaml -j 3 --store three.db
expect 0 "$clast" run one.yaml -j 2 --in-process --store inside.db
expect 0 mpirun -n 3 --oversubscribe "$clast" run one.yaml --store ranks.db
expect 0 mpirun -n 2 --oversubscribe "$clast" run one.yaml -j 2 --store pools.db
for store in two three inside ranks pools; do dump $store.db >/dev/null; same_as one.db $store.db; done

# Interrupted at random instants, again and again; each time in its own way.
RANDOM=$$ ; echo "instants drawn from RANDOM=$$"
stop() { # store signal command...
  local store=$1 signal=$2; shift 2
  setsid "$@" --store "$store" >/dev/null 2>>stopped.err &
  local pid=$!
  sleep "$((RANDOM % 2)).$((RANDOM % 10))" # results are committed once a second: stop before and after a commit
  kill "-$signal" "$pid" 2>/dev/null || true
  local got=0
  wait "$pid" 2>/dev/null || got=$?
  echo "  $signal: exit $got, $(python dump.py "$store" 2>/dev/null | tail -n 1)"
}
for signal in KILL KILL TERM KILL INT; do stop killed.db $signal "$clast" run one.yaml -j 2; done
for signal in KILL TERM KILL; do stop killed-inside.db $signal "$clast" run one.yaml -j 2 --in-process; done
for signal in KILL TERM; do stop killed-ranks.db $signal mpirun -n 3 --oversubscribe "$clast" run one.yaml; done
expect 0 "$clast" run one.yaml -j 3 --store killed.db
expect 0 "$clast" run one.yaml -j 2 --store killed-inside.db
expect 0 "$clast" run one.yaml -j 2 --store killed-ranks.db
for store in killed killed-inside killed-ranks; do dump $store.db >/dev/null; same_as one.db $store.db; done

# Nothing is computed twice.
expect 0 "$clast" run one.yaml -j 2
says "0 runs computed"; says "48 found in the store"
sed 's/per_point: 12/per_point: 14/' one.yaml >deeper.yaml
expect 0 "$clast" run deeper.yaml -j 2
says "8 runs computed"; says "48 found in the store"
sed 's/\[2 deg, 6 deg\]/[2 deg, 4 deg, 6 deg]/' one.yaml >wider.yaml
expect 0 "$clast" run wider.yaml -j 2
says "24 runs computed"; says "48 found in the store"

surplus() { python -c "import sqlite3, sys; print(sqlite3.connect(sys.argv[1]).execute('select sum(surplus) from run').fetchone()[0])" "$1"; }
# A rule finds the same prefix for any number of slots; runs computed ahead are surplus. Eight slots are always ahead, three not.
sed '/^seeds/d; /threshold.angle/d' one.yaml >until.yaml
echo "seeds: {until: {quantity: largest_fraction, half_width: 0.03, minimum: 10, batch: 5}, max: 60}" >>until.yaml
expect 0 "$clast" run until.yaml -j 1 --store until-one.db
expect 0 "$clast" run until.yaml -j 8 --store until-eight.db
ahead=$(surplus until-eight.db)
[ "$ahead" -eq 0 ] || says "$ahead run$([ "$ahead" -eq 1 ] || echo s) beyond the stopping rule: stored, but not counted"
expect 0 mpirun -n 3 --oversubscribe "$clast" run until.yaml -j 2 --store until-ranks.db
for store in until-one until-eight until-ranks; do echo "  $store: $(dump $store.db), $(surplus $store.db) surplus"; done
ahead=$(($(surplus until-one.db) + $(surplus until-eight.db) + $(surplus until-ranks.db)))
[ $ahead -gt 0 ] || fail "nothing was computed ahead: the comparison says little"
same_as until-one.db until-eight.db
same_as until-one.db until-ranks.db
expect 0 "$clast" run until.yaml -j 8 --store until-eight.db
says "0 runs computed"
done_after 27
