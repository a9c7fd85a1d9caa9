#!/usr/bin/env bash
# Every SQL and Python block of db/README.md, run on a store with the axes and the seeds of the demo.
. "$(dirname "$0")/lib.bash"

tiny demo
expect 0 "$clast" run demo.yaml -j 2 --seeds 20 # exponents that tables show
lines=$(wc -l <"$source/db/README.md")
[ "$lines" -le 220 ] || fail "db/README.md has $lines lines, more than 220"

# blocks LANGUAGE: writes each block to LANGUAGE-N.
blocks() {
  awk -v language="$1" '
    $0 == "```" language { inside = 1; n++; next }
    $0 == "```" { inside = 0 }
    inside { print > (language "-" n) }' "$source/db/README.md"
}
blocks sql
blocks python
for block in sql-*; do
  expect 0 sqlite3 -bail demo.db ".read $block"
  silent err
  case "$(cat "$block")" in *"FROM attempt"*) ;; *) [ -s out ] || fail "no rows: $(cat "$block")" ;; esac
  expect 0 "$clast" query demo.db "$(cat "$block")" # our own connection takes the same text
done

# A standard error is of the runs of one point.
same "$(sed -n 's/.*runs.groupby(\[\(.*\)\]).largest_fraction.*/\1/p' "$source/db/README.md" | tr -d '"')" \
  "$(number demo.db "select group_concat(column_name, ', ') from (select * from axis order by path desc)" | tr -d '"')" "inputs of a group"

python -c "import pandas" 2>/dev/null || cat >pandas.py <<'PY'
def read_sql(text, connection):
    rows = connection.execute(text).fetchall()
    assert rows, text
    return rows
PY
for block in python-*; do
  cp "$block" "$block.py"
  expect 0 env PYTHONPATH=. python3 "$block.py"
done
done_after 24
