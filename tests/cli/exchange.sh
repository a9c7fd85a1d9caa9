#!/usr/bin/env bash
# Points in from other programs, rows out to them: `design: {file: ...}`, `clast export --per`.
. "$(dirname "$0")/lib.bash"

tiny rows
expect 0 "$clast" run rows.yaml -j 2 --quiet

# ---- rows out: per point and per run, as CSV and JSON Lines, on standard output and in a file
expect 0 "$clast" export rows.db --per point
silent err
cp out points.csv
expect 0 "$clast" export rows.db --per run --jsonl
cp out runs.jsonl
expect 0 "$clast" export rows.db --per point --jsonl
cp out points.jsonl
expect 0 "$clast" export rows.db runs.csv --per run
says "runs.csv written"
silent out
expect 0 python - <<'PY'
import csv, json, sqlite3
store = sqlite3.connect("file:rows.db?mode=ro", uri=True)
store.row_factory = sqlite3.Row
for view, name in (("points", "points"), ("runs", "runs")):
    rows = [dict(row) for row in store.execute(f"SELECT * FROM {view}")]
    table = list(csv.DictReader(open(f"{name}.csv", newline="")))
    lines = [json.loads(line) for line in open(f"{name}.jsonl")]
    assert len(rows) == len(table) == len(lines) == {"points": 4, "runs": 12}[view]
    for row, cells, line in zip(rows, table, lines):
        assert list(row) == list(cells) == list(line)
        for key, value in row.items():
            if isinstance(value, bytes):
                value = value.hex()
            assert line[key] == value, (key, line[key], value)
            if value is None:
                assert cells[key] == ""
            elif isinstance(value, (int, float)):
                assert float(cells[key]) == value, key
            else:
                assert cells[key] == value, key
PY
ok "CSV and JSON Lines hold the views to the last bit"
expect 64 "$clast" export rows.db --per grain
says "expects run or point"
expect 64 "$clast" export rows.db --jsonl
expect 64 "$clast" export rows.db
says "needs a target"
expect 64 "$clast" export rows.db --per run --csv --jsonl
expect 66 "$clast" export none.db --per run
done_after 12
