#!/usr/bin/env bash
# Every command and campaign that campaign/README.md quotes works, in the order in which they stand there.
. "$(dirname "$0")/lib.bash"
guide=$source/campaign/README.md

# Blocks of yaml whose first line is "# FILE.yaml" become that file; the lines of sh blocks are the commands.
awk '/^```/ { kind = substr($0, 4); file = ""; next }
  kind == "yaml" && !file && /^# .*\.yaml$/ { file = $2 }
  kind == "yaml" && file { print > file }
  kind == "sh" { print > "commands" }' "$guide"
same "$(ls ./*.yaml | tr '\n' ' ')" "./accurate.yaml ./forms.yaml ./guide.yaml ./levels.yaml ./measured.yaml ./my-rock.yaml ./rocks.yaml ./unknown.yaml ./until.yaml " "campaigns of the guide"

mkdir -p bin
ln -s "$clast" bin/clast
export PATH=$work/bin:$PATH
count=0
while IFS= read -r line; do
  timeout 120 bash -c "$line" >out 2>err </dev/null || fail "exit $? of: $line"
  count=$((count + 1))
done <commands
same "$count" "$(grep -c . commands)" "commands that work"
[ "$count" -gt 25 ] || fail "only $count commands"

# Every key of the JSON Schema is in the table of keys.
for key in $(python -c "
import json
keys = json.load(open('$source/schemas/campaign.schema.json'))['properties']
for key, value in keys.items():
    inner = value.get('properties') if key in ('seeds', 'accuracy', 'limits', 'keep') else None
    print(*[f'{key}.{k}' for k in inner] if inner else [key])"); do
  grep -qF "| \`$key\` |" "$guide" || fail "the guide does not have the key $key"
done
ok "all keys are in the guide"
expect 0 "$clast" stats guide.db --quantity first_break,energy_kinetic
prints "first_break [s]"; prints "energy_kinetic [J/m]"
done_after 4
