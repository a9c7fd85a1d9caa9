#!/usr/bin/env bash
# Points in from other programs, rows out to them: `design: {file: ...}`, `clast export --per`, and every command and Python
# block of campaign/exchange.md.
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
expect 74 "$clast" export rows.db --bits /dev/full
says "No space left on device"
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
expect 64 "$clast" export rows.db rows.csv
says "For rows give --per run"
expect 64 "$clast" export rows.db
says "needs a target"
expect 64 "$clast" export rows.db --per run --csv --jsonl
expect 66 "$clast" export none.db --per run

# ---- points in: a design from a file, with units of columns and of cells
mkdir in
cat >in/design.yaml <<'YAML'
name: design
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
design: {file: points.csv}
seeds: {per_point: 3}
store: design.db
YAML
printf '\xef\xbb\xbf"strain [1]","threshold.angle [deg]"\r\n0.02,2\r\n\r\n# a note\n5 %%,2\n0.02,0.10471975511965977 rad\n"5e-2",6 deg' >in/points.csv
expect 0 "$clast" run in/design.yaml -j 2 --quiet
"$clast" query rows.db "select identity, largest_fraction from runs order by 1" --csv >grid.csv
"$clast" query design.db "select identity, largest_fraction from runs order by 1" --csv | cmp -s - grid.csv ||
  fail "the file's points are not those of the grid"
ok "points of a file are the runs of the same grid, to the last bit"
same "$(number design.db "select count(*) from campaign where document like '%# design.file: 4 points, sha256 $(sha256sum in/points.csv | cut -d' ' -f1)%'")" 1 "campaigns with the sum of the file"
expect 0 "$clast" run in/design.yaml
says "0 runs computed"
printf '\n0.03,2\n' >>in/points.csv
expect 0 "$clast" run in/design.yaml
says "3 runs computed"
says "12 found in the store"
same "$(number design.db "select count(*) from campaign")" 2 "another file of points is another campaign"
expect 0 "$clast" plan in/design.yaml --no-trial

# points_say TEXT MESSAGE...: the file is refused (65) with all messages.
points_say() {
  printf "$1" >in/points.csv
  expect 65 "$clast" plan in/design.yaml --no-trial
  local message
  for message in "${@:2}"; do says "$message"; done
}
points_say 'strain,angel\n0.02,2\n' "design.yaml:4:16: error: design.file: points.csv:1:" "angle"
points_say 'strain,threshold.strain\n0.02,2\n' "points.csv:1: two columns for threshold.strain"
points_say '"",strain\n1,0.02\n' "points.csv:1: column 1 has no name" "index=False"
points_say 'strain [1],threshold.angle [deg]\n0.02,2\n0.02,2 s\n0.02\n0.02,\n-1,2\n' "points.csv:3:" "points.csv:4: 1 cells, but the header has 2" \
  "points.csv:5: threshold.angle: the cell is empty" "points.csv:6:"
points_say 'strain [1],threshold.angle [kg]\n0.02,2\n' "points.csv:2:" "kg"
points_say 'strain\n"0.02\n' "points.csv:2: a double quote is not closed"
points_say 'strain\n' "no points"
points_say '' "no points"
points_say 'strain,beam.friction\n0.02,\0\n' "points.csv:"
points_say 'strain;threshold.angle [deg]\n2,5 %%;3\n2.5 %%;4\n' "points.csv:3: threshold.strain: '2.5 %': numbers above have the other decimal mark"
points_say 'strain [1],threshold.angle [deg]\n"1,234",3\n' "points.csv:2: threshold.strain: '1,234'" "write a decimal point"
points_say 'strain [1]\n0,02\n' "points.csv:2: 2 cells, but the header has 1; a decimal comma needs semicolons"
printf 'strain [%%];threshold.angle [deg]\n2;2\n5;2\n2;6\n5,0;6,0 deg\n' >in/points.csv
expect 0 "$clast" run in/design.yaml --store european.db -j 2 --quiet
"$clast" query european.db "select identity, largest_fraction from runs order by 1" --csv | cmp -s - grid.csv ||
  fail "points with decimal commas are not those of the grid"
ok "semicolons and decimal commas mean the same points"

# equal points are one, in the plan as in the run
printf 'strain [%%];threshold.angle [deg]\n2;2\n5;2\n2,0;2,00\n2 %%;2 deg\n' >in/points.csv
expect 0 "$clast" plan in/design.yaml --store equal.db --no-trial
prints "design    list, 2 points"
planned=$(sed -n 's/^runs *\([0-9]*\),.*/\1/p' out)
expect 0 "$clast" run in/design.yaml --store equal.db -j 2 --quiet
same "$(number equal.db "select count(*) from run")" "$planned" "runs of equal points"
rm in/points.csv
expect 65 "$clast" plan in/design.yaml --no-trial
says "cannot open 'in/points.csv'"
mkdir in/points.csv
expect 65 "$clast" plan in/design.yaml --no-trial
says "no plain file"

# ---- a crate for an archive
expect 0 "$clast" export design.db --crate crate --author 'A. "Nother" Person' --license https://creativecommons.org/licenses/by/4.0/
expect 0 python "$source/tests/cli/crate.py" crate
expect 0 "$clast" check crate/store.db
same "$(grep -c . crate/runs.csv)" 16 "lines of the crate's runs.csv"
cmp -s crate/campaign-1.yaml <("$clast" query design.db "select document from campaign where campaign_id = 1" --json |
  python -c "import json, sys; print(json.load(sys.stdin)[0]['document'], end='')") || fail "the campaign in the crate"
expect 0 "$clast" export rows.db plain --crate # neither author nor licence
expect 0 python "$source/tests/cli/crate.py" plain
expect 74 "$clast" export design.db --crate crate
says "is not empty"
expect 64 "$clast" export design.db --crate
expect 64 "$clast" export design.db other --csv --license x

# ---- the guide: blocks of yaml and csv whose first line is "# FILE" become files, blocks of sh and python run in order
mkdir -p guide bin
ln -s "$clast" bin/clast
export PATH=$work/bin:$PATH PYTHONPATH=$source/python PYTHONDONTWRITEBYTECODE=1
cd guide
awk '/^```/ { kind = substr($0, 4); file = ""; if (kind == "sh" || kind == "python") n++; next }
  (kind == "yaml" || kind == "csv") && !file && /^# / { file = $2; if (kind == "csv") next }
  (kind == "yaml" || kind == "csv") && file { print > file }
  kind == "sh" || kind == "python" { print > sprintf("block-%02d.%s", n, kind) }' "$source/campaign/exchange.md"
for block in block-*; do
  case $block in *.sh) run="bash -e" ;; *) run=/usr/bin/python3 ;; esac
  timeout 120 $run "$block" >out 2>err </dev/null || fail "exit $? of $block: $(cat "$block")"
done
cd ..
[ "$(ls guide/block-*.sh | wc -l)" -ge 2 ] && [ "$(ls guide/block-*.python | wc -l)" -ge 2 ] || fail "too few blocks in the guide"
ok "blocks of the guide"
expect 0 python - <<'PY'
import clast
rows = [list(map(float, line.split())) for line in open("guide/rebound.txt")]
body = clast.open("guide/ball.db").snapshot(1)
at = "VTKHDF/PointData/"
inside = [i for i, fragment in enumerate(body[at + "fragment"]) if fragment >= 0]
velocity = [float(v) for row in body[at + "velocity"] for v in (row if hasattr(row, "__len__") else [row])]
assert len(rows) == int(body["outcome/fragment_count"][0]) > 100 and all(len(row) == 8 for row in rows)
for name, theirs in (("mass", sum(row[0] for row in rows)),
                     ("volume", sum(4 / 3 * 3.141592653589793 * row[1] ** 3 for row in rows))):
    own = sum(body[at + "mass"][i] / (body[at + "density"][i] if name == "volume" else 1) for i in inside)
    assert abs(theirs / own - 1) < 1e-12, name
for axis in range(3):
    own = [body[at + "mass"][i] * velocity[3 * i + axis] for i in inside]
    assert abs(sum(row[0] * row[5 + axis] for row in rows) - sum(own)) < 1e-12 * sum(map(abs, own)), axis
PY
ok "fragments for REBOUND have mass, volume and momentum of their particles"
done_after 52
