#!/usr/bin/env bash
# The house rules that a machine can check (CONTRIBUTING.md): who includes whom, who may use which library, that nothing
# below main() prints or exits, what a file may export, that no path of a machine is written down, the format and the
# head of every file. house.py checks quotations in documents, names and words.
set -euo pipefail
build=$1 source=$2
cd "$source"
order=(schemas engine analysis db campaign)
failures=0
checked=0
fail() { echo "house: $*"; failures=$((failures + 1)); }

# Lines of C files of the five folders that match an extended regular expression, as FILE:LINE:TEXT.
lines_of_code() { grep -rnE "$1" --include='*.[ch]' "${order[@]}" || true; }

# Includes go left only: schemas <- engine <- analysis <- db <- campaign. Right of engine nothing knows one engine.
check_includes() {
  local -A rank
  local i file line text from to path
  for i in "${!order[@]}"; do rank[${order[$i]}]=$i; done
  while IFS=: read -r file line text; do
    from=${file%%/*}
    to=${text#*\"}
    to=${to%%\"*}
    path=$to
    case "$to" in
      */*) to=${to%%/*} ;;
      *) continue ;; # a header that the build generates
    esac
    checked=$((checked + 1))
    if [ -z "${rank[$to]:-}" ]; then
      fail "$file:$line: include from the root, folder first: $text"
    elif [ "${rank[$to]}" -gt "${rank[$from]}" ]; then
      fail "$file:$line: $from may not include $to"
    elif [[ $from != engine && $path =~ ^engine/([a-z]+)/ && -d engine/${BASH_REMATCH[1]}/scene ]]; then
      fail "$file:$line: $from may not know one engine: $path"
    fi
  done < <(lines_of_code '^#[[:space:]]*include[[:space:]]*"')
}

# only HEADERS FOLDERS: both regular expressions.
only() {
  local file line text
  while IFS=: read -r file line text; do
    [[ $file =~ ^($2)/ ]] || fail "$file:$line: only $2 may use this library: $text"
  done < <(lines_of_code "^#[[:space:]]*include[[:space:]]*<($1)")
}

# Each external library is used only in its own files.
check_libraries() {
  only 'libfyaml' schemas
  only 'hdf5' 'engine|analysis/pictures'
  only 'Random123' engine
  only 'sqlite3' db
  only 'cairo' analysis
  only 'zlib' analysis/report
  only 'gsl' 'analysis|campaign/design'
  only 'mpi\.h' campaign/farm
  only 'libqhull' tests
  only 'microhttpd' campaign/serve
  only 'jansson' campaign
}

# Nothing below the commands prints to the terminal or ends the process. Only the reader of fields files, where HDF5 runs,
# and the engine of other people's programs have children to end; and schemas/memory.c ends the process when small memory is refused.
check_printing() {
  local file line text
  while IFS=: read -r file line text; do
    case "$file" in campaign/* | *.h | schemas/memory.c) continue ;; esac
    case "$file:$text" in analysis/pictures/snapshot_read.c:*' _exit('* | engine/command/child.c:*' _exit('*) continue ;; esac
    fail "$file:$line: libraries return a status; they do not print or exit: $text"
  done < <(lines_of_code '(^|[^_a-z])(printf|puts|perror|exit|abort|_exit)[[:space:]]*\(' |
    grep -vE ':[[:space:]]*(\*|/\*|//)')
}

# fits SYMBOL FILE: the file's name, or a folder's below the top one and the file's, is the prefix of the symbol. In
# engine/sph/pairs/chunks.c: chunks_..., pairs_chunks_..., sph_chunks_... The name of a header that several files share
# will do, too: mesh_... in engine/mesh/formats.c beside mesh.h, field_... in schemas/field_print.c beside field.h.
fits() {
  local symbol=$1 stem=${2##*/} folder=${2%/*} rooms names room name
  stem=${stem%.c}
  names=$stem
  [ ! -f "$folder/${stem%%_*}.h" ] || names+=" ${stem%%_*}"
  rooms=${folder##*/}
  [ "$rooms" = "$folder" ] || [ ! -f "$folder/$rooms.h" ] || names+=" $rooms"
  for name in $names; do
    rooms=$folder
    case "$symbol" in "$name" | "$name"_*) return 0 ;; esac
    while [ "$rooms" != "${rooms%/*}" ]; do
      room=${rooms##*/}
      rooms=${rooms%/*}
      case "$symbol" in
        "${room}_$name"*) return 0 ;;
        "$room"_*) [ "$room" != "$stem" ] || return 0 ;;
      esac
    done
  done
  return 1
}

# OBJECT SYMBOL of everything that an archive exports.
exports() {
  nm -A --defined-only --extern-only "$1" 2>/dev/null |
    sed -nE 's/^[^:]*:([^:]+):[0-9a-f]* [TDRBGSC] ([A-Za-z_][A-Za-z0-9_]*)$/\1 \2/p' |
    grep -vE ' (__asan|__odr|_GLOBAL|__ubsan|__start|__stop)' || true
}

# A file's name is the prefix of what it exports. Two engines may have a file of one name: either's prefix will do.
check_exports() {
  local folder archive object symbol file files fitting
  for folder in "${order[@]}"; do
    archive=$build/$folder/libclast_$folder.a
    [ -f "$archive" ] || { fail "no $archive: build first"; continue; }
    while read -r object symbol; do
      mapfile -t files < <(find "$folder" -name "${object%.c.o}.c")
      [ "${#files[@]}" -gt 0 ] || continue # a source that the build generates
      checked=$((checked + 1))
      fitting=no
      for file in "${files[@]}"; do
        if fits "$symbol" "$file"; then fitting=yes; fi
      done
      [ $fitting = yes ] || fail "$file exports $symbol: expected ${object%.c.o}_... or FOLDER_${object%.c.o}_..."
    done < <(exports "$archive")
  done
}

# No file contains a path of a machine.
check_machine_paths() {
  local hit
  while IFS= read -r hit; do
    fail "path of a machine: $hit"
  done < <(grep -rnIE '(^|[^A-Za-z])/(work|home|root)/' "${order[@]}" tests ./*.md CMakeLists.txt CMakePresets.json \
    setup.sh .ci 2>/dev/null | grep -v '^tests/unit/house.sh:' || true)
}

# Every C file has the format of clang-format.
check_format() {
  command -v clang-format >/dev/null || { fail "clang-format is missing: ./setup.sh packages installs it"; return; }
  local hit
  while IFS= read -r hit; do
    fail "not formatted (clang-format -i FILE): $hit"
  done < <(find "${order[@]}" tests -name '*.[ch]' -print0 |
    xargs -0 -P 4 -n 40 clang-format --dry-run --ferror-limit=1 2>&1 | sed -nE 's/^(.*): (warning|error):.*/\1/p')
}

# Every C file begins with a comment that says what it is for.
check_heads() {
  local file first
  while IFS= read -r file; do
    checked=$((checked + 1))
    IFS= read -r first <"$file" || true
    case "$first" in
      '/* '*' '*) ;;
      *) fail "$file does not begin with a comment that says what it is for" ;;
    esac
  done < <(find "${order[@]}" tests -name '*.[ch]')
}

# SQL text of C stays in db. The page of `clast report` reads small stores of its own in a browser: its questions stay in questions.js.
check_sql() {
  local file line text
  while IFS=: read -r file line text; do
    [ "$file" != analysis/report/questions.js ] || continue
    fail "$file:$line: SQL of the page belongs into analysis/report/questions.js: $text"
  done < <(grep -rnE '(SELECT|FROM|INSERT|WHERE) ' --include='*.js' analysis || true)
  while IFS=: read -r file line text; do
    case "$file" in db/*) continue ;; esac
    fail "$file:$line: SQL belongs into db/ask: $text"
  done < <(grep -rniE '"[^"]*(select |insert into|update [a-z_]+ set|delete from|create (table|view|index))' \
    --include='*.[ch]' "${order[@]}" | grep -vE ':[[:space:]]*(\*|/\*|//)' || true)
}

# Outputs are put in place by schemas/file.c alone, and whoever opens an input notes it there (file_input), so that no
# output replaces it. Exceptions: files of the system; a store (db/store/store.c notes it); a restart file, which is input
# and output, and a fields file, which `run` makes again; gnuplot's messages; the child that snapshot_read.c starts; a document that is opened again to be read; the
# folder that a run of another program has for itself.
check_files() {
  local file line text
  while IFS=: read -r file line text; do
    checked=$((checked + 1))
    case "$file" in
      schemas/file.c | db/store/store.c | campaign/farm/* | campaign/main.c | campaign/scheduler/provenance.c) continue ;;
      engine/command/child.c | engine/command/output.c) continue ;;
    esac
    [[ ! $text =~ (rename|mkstemps?|creat|fdopen|freopen)\(|\"[wa][bx+e]*\"\)|O_CREAT ]] ||
      fail "$file:$line: an output is written by schemas/file.h: $text"
    case "$file" in
      engine/restart.c | db/store/digest.c | analysis/pictures/chart.c | campaign/converge/study_request.c) continue ;;
    esac
    grep -q 'file_input(' "$file" || fail "$file:$line: call file_input() before an input is opened: $text"
  done < <(lines_of_code '(^|[^_a-zA-Z0-9])(fopen|open|rename|mkstemps?|creat|fdopen|freopen|H5Fopen)\(' |
    grep -vE ':[[:space:]]*(\*|/\*|//)')
}

check_includes
check_files
check_libraries
check_printing
check_exports
check_machine_paths
check_format
check_heads
check_sql

[ "$checked" -gt 1000 ] || fail "looked at too little ($checked things)"
echo "house: $checked includes, exports and files checked, $failures broken"
words=0
/usr/bin/python3 tests/unit/house.py "$build/clast" "$build" "$source" || words=1
[ "$failures" -eq 0 ] && [ $words -eq 0 ]
