#!/usr/bin/env bash
# Documents that a machine can check: every case of verification and validation has a page of one form and a row in the
# index, and every link of a document leads to a file.
set -euo pipefail
source=$2
cd "$source"
failures=0 pages=0 links=0
fail() { echo "contributing: $*"; failures=$((failures + 1)); }

# 1. Pages: five parts in this order, listed in tests/README.md; "Pass if" or "No gate" says what is asked.
for page in tests/verification/*.md tests/validation/*.md; do
  pages=$((pages + 1))
  parts=$(grep -E '^## ' "$page" | tr '\n' ' ')
  [ "$parts" = '## Claim ## Criterion ## Measured ## Repeat ## Deviations ' ] || fail "$page: parts are: $parts"
  grep -qiE 'pass( |,|$)|no gate' "$page" || fail "$page: no criterion: write \"Pass if\""
  grep -qF "(${page#tests/})" tests/README.md || fail "$page: no row in tests/README.md"
done
for test in tests/verification/test_*.c tests/validation/test_*.c; do
  name=$(basename "$test" .c)
  grep -qlE "tests/$name([^a-z_]|$)" tests/verification/*.md tests/validation/*.md || fail "$test: no page says how to repeat it"
done

# 2. Links of documents lead to files.
while IFS=: read -r document link; do
  links=$((links + 1))
  [ -e "$(dirname "$document")/${link#](}" ] || fail "$document: no such file: ${link#](}"
done < <(grep -rHoE '\]\([^):#]+' --include='*.md' --exclude-dir=build --exclude-dir=node_modules . | grep -v 'http')

[ "$pages" -ge 30 ] && [ "$links" -ge 50 ] || fail "looked at too little ($pages pages, $links links)"
echo "contributing: $pages pages and $links links checked, $failures broken"
[ "$failures" -eq 0 ]
