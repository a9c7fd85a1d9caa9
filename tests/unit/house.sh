#!/usr/bin/env bash
# The house rules that a machine can check (CONTRIBUTING.md): who includes whom, what a file may export, who may use
# which library, that nothing below main() prints or exits, and that no path of a machine is written down.
set -euo pipefail
build=$1 source=$2
cd "$source"
failures=0
fail() { echo "house: $*"; failures=$((failures + 1)); }
checked=0

# 1. Includes go left only: schemas <- engine <- analysis <- db <- campaign.
order=(schemas engine analysis db campaign)
declare -A rank
for i in "${!order[@]}"; do rank[${order[$i]}]=$i; done
while IFS=: read -r file line text; do
  from=${file%%/*}
  to=$(sed -E 's/^#[[:space:]]*include[[:space:]]*"([^"]+)".*/\1/' <<<"$text")
  case "$to" in
    */*) ;;
    *) continue ;; # generated headers of the build folder
  esac
  to=${to%%/*}
  checked=$((checked + 1))
  [ -n "${rank[$to]:-}" ] || { fail "$file:$line: include from the root, folder first: $text"; continue; }
  [ "${rank[$to]}" -le "${rank[$from]}" ] || fail "$file:$line: $from may not include $to"
done < <(grep -rnE '^#[[:space:]]*include[[:space:]]*"' --include='*.[ch]' "${order[@]}")

# 2. Outside libraries stay where they belong.
only() { # header pattern, allowed folders (regex)
  while IFS=: read -r file line text; do
    [[ $file =~ ^($2)/ ]] || fail "$file:$line: only $2 may use this library: $text"
  done < <(grep -rnE "^#[[:space:]]*include[[:space:]]*<($1)" --include='*.[ch]' "${order[@]}")
}
only 'libfyaml' schemas
only 'hdf5' 'engine|analysis/pictures'
only 'Random123' engine
only 'sqlite3' db
only 'plfit|cairo' analysis
only 'gsl' 'analysis|campaign/design'
only 'mpi\.h' campaign/farm
only 'libqhull' tests

# 3. Nothing below the commands prints to the terminal or ends the process.
while IFS=: read -r file line text; do
  case "$file" in campaign/*) continue ;; esac
  fail "$file:$line: libraries return a status; they do not print or exit: $text"
done < <(grep -rnE '(^|[^_a-z])(printf|puts|perror|exit|abort|_exit)[[:space:]]*\(' --include='*.c' "${order[@]}" | grep -vE ':[[:space:]]*(\*|/\*|//)')

# 3b. SQL text stays in db; the one example is in the help of `clast query`, whose user writes SQL.
while IFS=: read -r file line text; do
  [ "$file" = campaign/commands/query.c ] || fail "$file:$line: SQL belongs into db/ask: $text"
done < <(grep -rniE '"[^"]*(select |insert into|update [a-z_]+ set|delete from|create (table|view|index))' --include='*.[ch]' \
  schemas engine analysis campaign | grep -vE ':[[:space:]]*(\*|/\*|//)' || true)

# 4. A file's name is the prefix of what it exports.
archives=0
for folder in "${order[@]}"; do
  archive=$build/$folder/libclast_$folder.a
  [ -f "$archive" ] || { fail "no $archive: build first"; continue; }
  archives=$((archives + 1))
  while read -r object symbol; do
    stem=${object%.c.o}
    mapfile -t files < <(find "$folder" -name "$stem.c") # two engines may have a file of one name: either's prefix will do
    [ "${#files[@]}" -gt 0 ] || continue                 # generated sources
    checked=$((checked + 1)) fits=no
    for file in "${files[@]}"; do
      case "$symbol" in "$stem" | "$stem"_*) fits=yes ;; esac
      rooms=${file%/*}
      while [ "$rooms" != "${rooms%/*}" ]; do # every folder below the top one, e.g. pairs and sph of engine/sph/pairs/chunks.c
        room=${rooms##*/} rooms=${rooms%/*}
        case "$symbol" in
          "${room}_$stem" | "${room}_$stem"_*) fits=yes ;;
          "$room"_*) if [ "$room" = "$stem" ] || [[ $symbol == "${room}_${stem}"* ]]; then fits=yes; fi ;;
        esac
      done
    done
    [ $fits = yes ] || fail "$file exports $symbol: expected ${stem}_... or FOLDER_${stem}_..."
  done < <(nm -A --defined-only --extern-only "$archive" 2>/dev/null |
    sed -nE 's/^[^:]*:([^:]+):[0-9a-f]* [TDRBGSC] ([A-Za-z_][A-Za-z0-9_]*)$/\1 \2/p' | grep -vE ' (__asan|__odr|_GLOBAL|__ubsan|__start|__stop)' || true)
done

# 5. Nothing names a machine's folders.
while IFS= read -r hit; do fail "path of a machine: $hit"; done < <(grep -rnIE '(^|[^A-Za-z])/(work|home|root)/' --include='*' \
  "${order[@]}" tests README.md CONTRIBUTING.md CMakeLists.txt CMakePresets.json setup.sh .ci 2>/dev/null | grep -v 'tests/unit/house.sh' || true)

[ "$archives" -eq 5 ] && [ "$checked" -gt 20 ] || fail "looked at too little ($archives archives, $checked things)"
echo "house: $checked includes and exports checked, $failures broken"
[ "$failures" -eq 0 ]
