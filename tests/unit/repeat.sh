#!/usr/bin/env bash
# tests/repeat: every page of both folders has commands that bash understands and a cost; it runs a page and tells what failed.
set -euo pipefail
build=$(realpath "$1") source=$2
repeat=$source/tests/repeat
work=$(mktemp -d "$build/repeat-XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0 pages=0
fail() { echo "repeat: $*"; failures=$((failures + 1)); }
expect() { # expect CODE PATTERN ARGUMENT...: exit code, and a line of what tests/repeat prints
  local got=0 code=$1 pattern=$2
  shift 2
  "$repeat" --programs "$build" --output "$work/out" "$@" >said 2>&1 || got=$?
  [ "$got" -eq "$code" ] || fail "$*: exit $got, expected $code: $(<said)"
  grep -qE -- "$pattern" said || fail "$*: nothing like \"$pattern\" in: $(<said)"
}

expect 0 '^sum +[0-9.]+ h$' --list # a page without commands or cost is refused
list=$(<said)
for page in "$source"/tests/verification/*.md "$source"/tests/validation/*.md; do
  pages=$((pages + 1))
  name=$(basename "$page" .md)
  [[ $'\n'$list =~ $'\n'"$name "\ *(about )?[0-9.]+\ (s|min|h) ]] || fail "$name is not in --list"
  commands=$(sed -n '/^## Repeat/,/^## Dev/{/^```sh/,/^```$/{/^```/!p}}' "$page")
  bash -n <<<"$commands" || fail "$name: bash does not understand its commands"
done
[ "$pages" -ge 55 ] || fail "looked at $pages pages only"

page() { printf '# Page\n\n## Repeat\n%s\n\n## Deviations\nNone.\n' "$2" >"$1.md"; }
page good 'Text.

```sh
cat >"names of $(basename "$PWD")" <<END
$(command -v clast) $clast
END
cat names*
```
```sh
ls
```
Cost: 1.5 min of a processor.

```text
not run
```'
page bad $'```sh\nfalse | cat\necho not reached\n```\nCost: about 2 s of a processor.'
page no-cost $'```sh\ntrue\n```'
page no-block $'```text\ntrue\n```\nCost: 1 s of a processor.'
expect 0 '^good +90 s   more by hand$' --list good.md
expect 1 '^good: .* s of a processor, exit 0$' good.md bad.md
grep -qx 'failed: bad' said || fail "the page that failed is not told: $(<said)"
grep -qE '^sum +92 s ' said || fail "no sum: $(<said)"
grep -qxF "$build/clast $(realpath "$source")" out/good.txt || fail "good printed: $(<out/good.txt)"
grep -qx 'names of good' out/good.txt || fail "good was not run in its folder: $(<out/good.txt)"
! grep -q 'reached' out/bad.txt || fail "bad went on after its failure"
expect 0 '^good: ended well before$' good.md
expect 1 '^failed: bad$' bad.md
page long $'```sh\ntouch ../begun\nsleep 100\n```\nCost: 100 s of a processor.'
env --default-signal=INT "$repeat" --programs "$build" --output "$work/out" long.md >said 2>&1 &
until [ -e out/begun ] || ! kill -0 $!; do sleep 0.05; done
kill -INT $!
code=0; wait $! || code=$?
[ "$code" -eq 75 ] && grep -q stopped said || fail "after Ctrl-C: exit $code, $(<said)"
expect 1 'no-cost.md: .* no line Cost' no-cost.md
expect 1 'no-block.md: .* no block sh' no-block.md
expect 1 'no page nowhere' nowhere
echo "repeat: $pages pages looked at, $failures broken"
[ "$failures" -eq 0 ]
