#!/usr/bin/env bash
# Numbers that no run gives, in stores that another program has changed: +-1e308, 1e77, infinity, NULL (NaN) and the
# largest integers, in every numeric column and in the masses, in all rows and in one. Every command that prints from a
# store ends with a documented code that is not that of a bug, never by a signal, and without a report of a sanitizer.
# By default all columns of a table are changed at a time, half of the stores are left to the suite under sanitizers, and a
# store with one changed table gets a few of the ready queries, the next store the next ones: SQLite computes their numbers,
# and one piece of code prints them.
# CLAST_FULL=1 tries all, and columns one by one, too (hours).
. "$(dirname "$0")/../cli/lib.bash"

cat >range.yaml <<YAML
name: range
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
vary: {threshold.strain: {from: 2 %, to: 5 %, n: 2}, threshold.angle: {from: 2 deg, to: 6 deg, n: 2}}
seeds: {per_point: 3}
store: good.db
YAML
expect 0 "$clast" run range.yaml --quiet
expect 0 "$clast" sensitivity range.yaml design.yaml --design saltelli --blocks 2
expect 0 "$clast" run design.yaml --store good.db --quiet
expect 0 "$clast" converge disc-explosion --set body.diameter='8 cm' --set charge.energy='2 kJ/m' \
  --set stop.end_time='1 ms' --knob grains='8 mm,12 mm' --seeds 2 --within off --store good.db --quiet
"$clast" query --list --csv >ready.csv

cat >values.py <<'PY'
import concurrent.futures, csv, os, shutil, sqlite3, struct, subprocess, sys, threading

clast, sanitized, full = sys.argv[1], int(sys.argv[2]), os.environ.get("CLAST_FULL") == "1"
BIG, SMALL = 2**63 - 1, -(2**63)
INF = float("inf")
# Pairs of a real number and an integer: the columns of a store are STRICT.
VALUES = [(1e308, BIG), (-1e308, SMALL), (1e77, 2**31), (INF, 2**53 + 1), (-INF, -1), (None, None)]
IDENTITIES = {"run_id", "point_id", "session_id", "campaign_id", "attempt_id", "results_version"}

ready = [(row["name"], row["with"]) for row in csv.DictReader(open("ready.csv"))]
good = sqlite3.connect("good.db")
runs = [row[0] for row in good.execute("select run_id from run order by run_id")]
axes = "-x strain -y angle".split()


def commands(store, out, queries):
    """Every command that prints from a store, with these ready queries."""
    yield from (["stats", store], ["stats", store, "-b", "strain", "-Q", "main", "--csv"])
    yield from (["estimates", store, *form] for form in ([], ["--csv"], ["--json"]))
    yield ["exponents", store, "--draws", "20"]
    yield from (["scatter", store, *form] for form in ([], ["--csv"], ["--half-width", "0.01", "--json"]))
    yield from (["scatter", store, "-Q", name] for name in ("largest_speed", "fragment_count"))
    yield from (["status", store, *form] for form in ([], ["--json"]))
    yield from (["spectrum", store, *form] for form in ([], ["-c"], ["-c", "--json"], ["--runs", "--csv"], ["--size", "2700 kg/m^3"]))
    yield from (["compare", f"{store}:1", f"{store}:2"], ["compare", store, "good.db", "--csv"])
    for name, parameters in queries:
        values = [word for one in parameters.replace(",", " ").split() for word in ("-w", f"{one}={runs[0] if one == 'run' else 1}")]
        yield ["query", store, "-n", name, *values]
    yield from (["query", store, f"select * from {view}", *form]
                for view in ("runs", "points", "estimates", "spectra") for form in ([], ["--json"]))
    yield from (["extremes", store], ["check", store], ["sensitivity", store, "design.yaml"])
    yield ["replay", store, str(runs[0])]
    yield from (["export", store, f"{out}.{form}", *option.split()] for form, option in
                (("csv", "--per run"), ("jsonl", "--per point --jsonl"), ("folder", "--csv"), ("bits", "--bits"), ("db", "")))
    yield ["run", "range.yaml", "--store", store, "-j", "1"]
    yield ["plan", "range.yaml", "--store", store]
    yield ["estimates", store]


def pictures(store, out):
    """Commands that draw are slow: gnuplot. They run on one store of a table and value."""
    yield from (["map", store, f"{out}.map.png", *axes], ["plot", store, f"{out}.plot.svg", "-x", "strain", "-b", "angle", "-Q", "beta"])
    yield from (["spectrum", store, "--picture", f"{out}.spectrum.png"], ["scatter", store, "--picture", f"{out}.scatter.png"])
    yield ["report", store, "-o", f"{out}.html"]


def numeric_columns():
    """(table, key, [(column, type)]) of every table of the store with rows."""
    for (table,) in good.execute("select name from sqlite_schema where type = 'table' and name not like 'sqlite%' order by name").fetchall():
        if good.execute(f'select count(*) from "{table}"').fetchone()[0] == 0:
            continue
        columns = [(row[1], row[2]) for row in good.execute(f'pragma table_info("{table}")')
                   if row[2] in ("REAL", "INTEGER", "ANY") or row[1] == "masses"]
        columns = [(name, kind) for name, kind in columns if full or name not in IDENTITIES]
        if columns:
            yield table, columns


def hostile(name, size, kind, value):
    real, integer = value
    if name == "masses":
        return None if real is None else struct.pack("<d", real) * (size // 8)
    return integer if kind == "INTEGER" else real


def make(path, changes, value, everywhere):
    """Changes the columns in all rows or in one. Returns how many changes SQLite allowed."""
    shutil.copy("good.db", path)
    db = sqlite3.connect(path)
    db.execute("pragma ignore_check_constraints = on")
    db.execute("pragma foreign_keys = off")
    changed = sum(change(db, table, columns, value, everywhere) for table, columns in changes)
    db.commit()
    db.close()
    return changed


def change(db, table, columns, value, everywhere):
    first = db.execute(f'select min(rowid) from "{table}"').fetchone()[0] if has_rowid(db, table) else None
    changed = 0
    for name, kind in columns:
        size = (db.execute(f'select length("{name}") from "{table}"').fetchone()[0] or 0) if name == "masses" else 0
        where = "" if everywhere else f" where rowid = {first}" if first is not None else first_key(db, table)
        try:
            db.execute(f'update "{table}" set "{name}" = ?{where}', (hostile(name, size, kind, value),))
            changed += 1
        except sqlite3.DatabaseError:  # NOT NULL or UNIQUE: no store can have this value
            pass
    return changed


def has_rowid(db, table):
    try:
        db.execute(f'select rowid from "{table}" limit 1')
        return True
    except sqlite3.DatabaseError:
        return False


def first_key(db, table):
    keys = [row[1] for row in db.execute(f'pragma table_info("{table}")') if row[5]]
    names = ", ".join(f'"{key}"' for key in keys)
    return f' where ({names}) = (select {names} from "{table}" order by {names} limit 1)'


def cases():
    """(changes, value, in all rows?, print?, draw pictures?): all tables at a time with each value, in one row or, under
    sanitizers, in all of them; then each table with one value: under sanitizers all is printed, without them all is drawn.
    With CLAST_FULL=1 each column with each value."""
    tables = list(numeric_columns())
    places = [(value, everywhere) for value in VALUES for everywhere in (True, False)]
    if full:
        for table, columns in tables:
            for column in columns:
                for value, everywhere in places:
                    yield [(table, [column])], value, everywhere, True, False
    for value, everywhere in places:
        if full or everywhere == bool(sanitized):
            yield tables, value, everywhere, True, True
    for number, table in enumerate(tables):
        yield [table], VALUES[number % len(VALUES)], number % 2 == 0, full or sanitized, not sanitized


lock, asked, changed, faults, widest = threading.Lock(), 0, 0, {}, 0


def fault(what, kind, told=""):
    """Prints the first fault of a kind in full."""
    if faults.setdefault(kind, 0) == 0 or full:
        print(f"FAULT {what}: {kind} {told}", flush=True)
    faults[kind] += 1


def try_store(numbered):
    global asked, changed, widest
    number, (changes, value, everywhere, prints, draws) = numbered
    path, out = f"case{number}.db", f"case{number}"
    allowed = make(path, changes, value, everywhere)
    with lock:
        changed += allowed
    turn = ready if full or len(changes) > 1 else (ready * 2)[6 * number % len(ready) :][:6]
    for argv in [*(commands(path, out, turn) if prints else []), *(pictures(path, out) if draws else [])] if allowed else []:
        names = [f"{table}.{name}" for table, columns in changes for name, _ in columns] if full else [table for table, _ in changes]
        what = f"{' '.join(names)} = {value}{'' if everywhere else ' in one row'}: clast {' '.join(argv)}"
        try:
            done = subprocess.run([clast, *argv], capture_output=True, timeout=300, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            with lock:
                fault(what, f"{argv[0]}: no end after 300 s")
            continue
        told = done.stderr.decode(errors="replace")
        wide = max((len(line) for line in done.stdout.decode(errors="replace").split("\n")), default=0) if not (
            {"--csv", "--json"} & set(argv) or argv[0] in ("query", "check")) else 0  # sentences may be long
        with lock:
            asked += 1
            widest = max(widest, wide)
            if done.returncode < 0 or done.returncode in (70, 134, 139) or "Sanitizer" in told or "runtime error" in told:
                fault(what, f"{argv[0]}: exit {done.returncode}", told[-1500:])
            elif wide > 240:
                fault(what, f"{argv[0]}: a line of {wide // 100}.. hundred columns")
    for name in os.listdir("."):
        if name.startswith(f"{out}."):
            shutil.rmtree(name, ignore_errors=True) if os.path.isdir(name) else os.remove(name)


with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
    list(pool.map(try_store, enumerate(cases())))
print(f"{asked} commands on stores with {changed} changed columns; the longest line has {widest} columns")
sys.exit(bool(faults) or asked < (1000 if full or sanitized else 400))
PY
python values.py "$clast" "$sanitized" || fail "see the faults above"
done_after 4
