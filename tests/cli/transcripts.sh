#!/usr/bin/env bash
# What commands print for programs (CSV, JSON, files) and for people, and say on stderr, on stores of the toy engine, whose
# numbers hang on no machine: transcripts.txt beside this file is run again and compared (transcripts.py). The numbers that
# the others rest on are computed a second time here, by their formulas.
. "$(dirname "$0")/lib.bash"
ln -s "$toy" bin/clast
# freeze STORE [WORDS]: times, memory and machine of its runs become numbers that are the same everywhere, and some runs get
# the words of warnings. The order in which runs were stored, and their run_id, may differ. Runs that were begun before a
# rule had ended their point (surplus) go: how many there are depends on the machine.
cat >bin/freeze <<'PY'
#!/usr/bin/python3
import sqlite3, sys
db = sqlite3.connect(sys.argv[1])
surplus = "run_id IN (SELECT run_id FROM run WHERE surplus)"
tables = [name for name, in db.execute("SELECT name FROM sqlite_master WHERE type = 'table' AND name <> 'run'")]
for table in tables + ["run"]:
    columns = [column[1] for column in db.execute(f"PRAGMA table_info({table})")]
    if "run_id" in columns:
        db.execute(f"DELETE FROM {table} WHERE {surplus}")
    elif "surplus" in columns:
        db.execute(f"UPDATE {table} SET surplus = 0")
db.execute("UPDATE run SET wall_time = point_id + 0.25 * replicate, cpu_time = point_id + 0.125 * replicate, peak_memory = 1024 * (1000 + 100 * point_id + replicate), host = 'here', finished_at = 1e9 + replicate")
db.execute("UPDATE session SET started_at = '2026-01-01T00:00:00.000Z', ended_at = '2026-01-01T00:00:10.000Z', host = 'here', pid = 1")
if len(sys.argv) > 2:
    db.execute("UPDATE run SET warnings = ? WHERE (point_id + replicate) % 5 = 0", (sys.argv[2],))
# The digests of tables know these edits: a store of version 3 has none.
db.execute("DROP TABLE IF EXISTS table_digest")
db.execute("DELETE FROM column_doc WHERE table_name = 'table_digest'")
db.execute("PRAGMA user_version = 3")
db.commit()
PY
chmod +x bin/freeze
# page FILE: the tables that a page of `clast report` holds, without the words of other engines; run_id is not the same everywhere.
cat >bin/page <<'PY'
#!/usr/bin/python3
import base64, gzip, re, sqlite3, sys
for packed in re.findall(r'class="store">\s*([A-Za-z0-9+/=]+)', open(sys.argv[1]).read()):
    db = sqlite3.connect(":memory:")
    db.deserialize(gzip.decompress(base64.b64decode(packed)))
    for table, in db.execute("SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT IN ('session', 'column_doc', 'question')").fetchall():
        print("==", table)
        for row in db.execute(f'SELECT * FROM "{table}"'):
            if row[0] not in ("dem", "sph", "program"):
                print(*("-" if value is None else value for value in row[table == "runs":]), sep="|")
PY
chmod +x bin/page
# script FILE: what gnuplot is told of this chart alone, and a digest of the lines that come from the templates.
cat >bin/script <<'SH'
#!/bin/sh
sed '/^# The page of every/,$d' "$1"
sed -n '/^# The page of every/,$p' "$1" | md5sum
SH
chmod +x bin/script

printf 'engine: toy\nstick: {trouble: true}\n' >stick.yaml
# grid: 2 x 2 points and 12 seeds, of which one is censored. few: a rule stops it. ask: a design of Saltelli.
cat >grid.yaml <<'YAML'
name: grid
scene: stick.yaml
vary:
  stick.strain: [2 %, 5 %]
  stick.angle: [2 deg, 6 deg]
seeds: {per_point: 12}
store: grid.db
YAML
cat >refused.yaml <<'YAML'
name: refused
scene: stick.yaml
vary: {stick.strain: [1 %, 3 %, 9 %]}
seeds: {per_point: 14, first: 8}
store: refused.db
YAML
cat >few.yaml <<'YAML'
name: few
scene: stick.yaml
vary: {stick.strain: [2.5 %, 4 %]}
seeds: {until: {quantity: largest_fraction, half_width: 0.002}, max: 200}
store: few.db
YAML
cat >sweep.yaml <<'YAML'
name: sweep
scene: stick.yaml
vary:
  stick.strain: {log_uniform: [1 %, 9 %]}
  stick.angle: {uniform: [2 deg, 6 deg]}
design: {kind: sobol, points: 8}
seeds: {per_point: 3}
store: sweep.db
YAML
cat >shot.yaml <<'YAML'
name: two sticks
source: made up for this test
shots:
  - name: a
    measured:
      - {quantity: largest_fraction, value: 0.86, error: 0.01, resolution: 0.005}
      - {quantity: count_above, share: 0.01, value: 3}
  - name: b
    fragments: {total: 302 g, complete: 0.5 g, masses: [250 g, 12 g, 7 g, 3 g, 2 g, 1 g, 0.7 g]}
YAML
# One number of two inputs is a ridge; two numbers determine both; angle changes nothing.
for fit in 'ridge 1 %, 20 %' 'both 1 %, 9 %' 'wide 2 %, 3 %'; do
  read -r name range <<<"$fit"
  printf '%s\n' "name: $name" 'scene: stick.yaml' 'vary:' "  stick.strain: {uniform: [$range]}" '  stick.coarse: {uniform: [1 kg, 20 kg]}' \
    'design: {kind: latin_hypercube, points: 10}' 'seeds: {per_point: 4}' "store: $name.db" >"$name.yaml"
done
sed -i 's/20 kg/200 kg/' ridge.yaml
sed -i 's/per_point: 4/per_point: 4, independent: false/' both.yaml # seeds that all points share
sed 's/^name: .*/name: alone/; s/coarse: .*/angle: {uniform: [2 deg, 6 deg]}/; s/^store: .*/store: alone.db/' ridge.yaml >alone.yaml
printf 'name: %s\nsource: made up\nshots: [{specimens: %s, measured: [{quantity: largest_fraction, value: 0.85, error: %s, resolution: 0}%s]}]\n' \
  one 1 0.01 '' >one_shot.yaml
printf 'name: %s\nsource: made up\nshots: [{specimens: %s, measured: [{quantity: largest_fraction, value: 0.85, error: %s, resolution: 0}%s]}]\n' \
  two 3 0.002 ', {quantity: mean_fragment_mass, value: 5 kg, error: 0.1 kg, resolution: 0}' >two_shot.yaml
printf '# source: made up\nmass (g), count\n8, 30\n20, 12\n50, 5\n200, 1\n' >measured.csv
expect 0 python "$source/tests/cli/transcripts.py" "$source/tests/cli/transcripts.txt"

# Means, standard deviations, their errors and t intervals by hand, of the rows that the transcript pins.
expect 0 clast stats grid.db --by strain,angle -Q fragment_count,largest_fraction --csv
python - <<'PY'
import csv, math, sqlite3, statistics
T11 = 2.2009851600916384  # 97.5 % quantile of Student's t with 11 degrees of freedom
runs = sqlite3.connect("grid.db").execute("SELECT stick_strain, stick_angle, largest_fraction, fragment_count FROM runs WHERE counts").fetchall()
for row in csv.DictReader(open("out")):
    values, counts = zip(*((m, n) for s, a, m, n in runs if (s, a) == (float(row["stick_strain"]), float(row["stick_angle"]))))
    for name, of in (("largest_fraction", values), ("fragment_count", counts)):
        sd = statistics.stdev(of)
        truths = {"mean": statistics.mean(of), "sd": sd, "se": sd / math.sqrt(12)}
        if name == "fragment_count":  # a share has intervals of its own (tests/verification/shares.md)
            truths["hw95"] = T11 * sd / math.sqrt(12)
        for what, truth in truths.items():
            most = 5e-6 if what == "hw95" else 1e-9  # the quantile in SQL (db/README.md)
            assert abs(float(row[f"{name}_{what}"]) / truth - 1) < most, (name, what, row, truth)
    assert len(values) == 12 and row["n"] == "12" and row["censored"] == "1", row
PY
ok "statistics of the points by hand"
# Masses of the pieces, as tests/support/toy_engine.c makes them: the largest of 20 + seed % 7 pieces has 5 kg more.
expect 0 clast query grid.db "SELECT seed, fragment_count, total_mass, largest_fraction FROM runs WHERE point_id = 1" --csv
python - <<'PY'
import csv
for row in csv.DictReader(open("out")):
    n, mass, first = int(row["fragment_count"]), float(row["total_mass"]), float(row["total_mass"]) * float(row["largest_fraction"])
    assert n == 20 + int(row["seed"]) % 7, row
    assert 5 + 0.2 / 2 <= first <= 5 + 0.2, row  # 10 * 2 % / (1 + u), 0 <= u < 1
    least = 5 + sum(0.2 / (2 + k) for k in range(n))
    assert least <= mass <= 5 + sum(0.2 / (1 + k) for k in range(n)), (least, row)
PY
ok "masses of the pieces by hand"
done_after 5
