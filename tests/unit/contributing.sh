#!/usr/bin/env bash
# Documents that a machine can check: every case of verification and validation has a page of one form and a row in the
# index, every link of a document leads to a file, and the worked examples of CONTRIBUTING.md name the files they touch.
set -euo pipefail
source=$2
cd "$source"
failures=0 pages=0 links=0
fail() { echo "contributing: $*"; failures=$((failures + 1)); }

# 1. Pages: five parts in this order, listed in tests/README.md; "Pass if" or "No gate" states the criterion.
for page in tests/verification/*.md tests/validation/*.md; do
  pages=$((pages + 1))
  parts=$(grep -E '^## ' "$page" | tr '\n' ' ')
  [ "$parts" = '## Claim ## Criterion ## Measured ## Repeat ## Deviations ' ] || fail "$page: parts are: $parts"
  grep -qiE 'pass( |,|$)|(no|without a) criterion' "$page" || fail "$page: no criterion: write \"Pass if\""
  grep -qF "(${page#tests/})" tests/README.md || fail "$page: no row in tests/README.md"
done
commands=$(sed -n '/^## Repeat/,/^## Dev/{/^```sh/,/^```$/p}' tests/verification/*.md tests/validation/*.md)
for test in tests/verification/test_*.c tests/validation/test_*.c; do
  name=$(basename "$test" .c)
  grep -qE "(^| )$name( |$)" <<<"$commands" || fail "$test: no page has it among the commands that repeat it"
done

# 2. Links of documents lead to files.
while IFS=: read -r document link; do
  links=$((links + 1))
  [ -e "$(dirname "$document")/${link#](}" ] || fail "$document: no such file: ${link#](}"
done < <(grep -rHoE '\]\([^):#]+' --include='*.md' --exclude-dir=build --exclude-dir=node_modules . | grep -v 'http')

# 3. The worked examples of CONTRIBUTING.md. A block "files" begins "NAME: N files of the program with the word WORD": the
# files listed are all C files that have the word. "NAME: N files" only lists them.
examples=0 head='' listed=''
check_example() {
  examples=$((examples + 1))
  [[ $head =~ ^([a-z ]+):\ ([0-9]+)\ files(\ of\ the\ program\ with\ the\ word\ ([a-z_]+))?$ ]] || { fail "CONTRIBUTING.md: not understood: $head"; return; }
  local name=${BASH_REMATCH[1]} count=${BASH_REMATCH[2]} word=${BASH_REMATCH[4]} file found
  for file in $listed; do [ -f "$file" ] || fail "CONTRIBUTING.md, $name: no such file: $file"; done
  [ "$(wc -w <<<"$listed")" -eq "$count" ] || fail "CONTRIBUTING.md, $name: $count files are announced, $(wc -w <<<"$listed") are listed"
  [ -n "$word" ] || return 0
  found=$(grep -rlw --include='*.[ch]' "$word" schemas engine analysis db campaign | sort | xargs)
  [ "$found" = "$(tr ' ' '\n' <<<"$listed" | sort | xargs)" ] || fail "CONTRIBUTING.md, $name: $word stands in $found"
}
inside=no
while IFS= read -r line; do
  case "$inside $line" in
    'no ```files') inside=head ;;
    'head '*) head=$line listed='' inside=files ;;
    'files ```') check_example; inside=no ;;
    'files '*) listed="$listed $line" ;;
  esac
done <CONTRIBUTING.md

[ "$pages" -ge 30 ] && [ "$links" -ge 50 ] && [ "$examples" -ge 6 ] || fail "looked at too little ($pages pages, $links links, $examples examples)"
echo "contributing: $pages pages, $links links and $examples examples checked, $failures broken"
[ "$failures" -eq 0 ]
