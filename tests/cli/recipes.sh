#!/usr/bin/env bash
# Every command and program of campaign/recipes.md works, in the order in which they stand there.
. "$(dirname "$0")/lib.bash"
page=$source/campaign/recipes.md

awk '{ sub(/^   /, "") } /^```/ { kind = substr($0, 4); file = ""; next }
  kind == "yaml" && !file && /^# .*\.yaml$/ { file = $2 }
  kind == "yaml" && file { print > file }
  kind == "python" { print > "recipe.py" }
  kind == "sh" { print > "commands" }' "$page"
mkdir -p bin
ln -s "$clast" bin/clast
export PATH=$work/bin:$PATH
python -c "import pandas" 2>/dev/null || sed -i '/pandas/d; /groupby/d; s/pandas.*/list(store.execute("SELECT 1 FROM runs"))/' recipe.py
count=0
while IFS= read -r line; do
  timeout 120 bash -c "$line" >out 2>err </dev/null || fail "exit $? of: $line"
  count=$((count + 1))
  case $line in
    "clast run discs.yaml") [ "$count" -gt 1 ] || { cp discs.db first.db; python recipe.py >out || fail "the program of the page"; } ;;
    "clast sensitivity which.db") tr '\n' ' ' <out | grep -qF "$(tr '\n' ' ' <"$page" | sed 's/.*The answer begins "//; s/".*//')" || fail "the page quotes another answer" ;;
    *fields_path*) grep -q 'discs' out || fail "no fields were kept" ;;
    *--snapshots*) [ -s disc-explosion.hdf.series ] || fail "no series for ParaView" ;;
  esac
done <commands
same "$count" 15 "commands that work"
same "$(number discs.db 'select count(*) from runs where counts')" 18 "runs of the extended campaign"
same "$(sqlite3 discs.db "attach 'first.db' as f; select count(*) from f.run a join main.run b on a.identity = b.identity and a.digest = b.digest")" \
  8 "old runs kept their bits"
bash -n "$source/campaign/examples/slurm.sh" || fail "slurm.sh"
done_after 3
