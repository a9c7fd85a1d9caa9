#!/usr/bin/env bash
# Other people's programs (engine command): the user's word before any program runs, one run, a campaign with its store, the
# same bits in any way of computing, and programs that hang, crash, or write nonsense, too much or nothing.
. "$(dirname "$0")/lib.bash"

cp "$source"/campaign/examples/bundle/* .
word=--allow-commands
mkdir tmp
export TMPDIR=$work/tmp

# scene NAME [LINE...]: NAME.yaml runs the script on stdin with sh; the lines belong to its section.
scene() {
  local name=$1 line
  shift
  cat >"$name.sh"
  cat >"$name.yaml" <<YAML
engine: command
name: $name
command:
  program: sh
  version: "1"
  arguments: [$name.sh, "{{a}}", "{{seed}}"]
  files: [$name.sh]
  inputs: {a: {default: 2, least: 0, most: 100, resolution: larger, doc: A number.}}
YAML
  for line in "$@"; do echo "  $line" >>"$name.yaml"; done
  grep -q ' results:' "$name.yaml" || echo '  results: {x: {doc: A result.}}' >>"$name.yaml"
  grep -q ' limits:' "$name.yaml" || echo '  limits: {time: 20 s, output: 100 kB}' >>"$name.yaml"
  printf 'name: %s\nscene: %s.yaml\nseeds: {per_point: 1}\nlimits: {attempts: 1}\n' "$name" "$name" >"$name-runs.yaml"
}
nothing_left() { # no folder of a run, and no process in one
  [ -z "$(ls tmp)" ] || fail "$1: folders of runs are left: $(ls tmp)"
}

# ---- no program runs without the user's word ----
scene mark <<SH
echo >$work/touched
echo '{"x": 1}'
SH
(cat mark-runs.yaml; echo 'vary: {a: [1, 2]}') >vary.yaml
for command in "simulate mark.yaml" "run mark-runs.yaml" "find mark-runs.yaml --input a --from 1 --to 2 --level 1" \
  "serve vary.yaml" "converge mark.yaml"; do
  expect 64 "$clast" $command
done
expect 64 "$clast" simulate mark.yaml
says "give --allow-commands if you trust it"; says "the program sh"; one_error
expect 0 "$clast" plan mark-runs.yaml
prints "not known without a trial run"; prints "memory    not known"
expect 0 "$clast" plan vary.yaml
! grep -q "most expensive" out || fail "the most expensive point of a program that was not timed"
expect 0 "$clast" plan vary.yaml --json
grep -q '"memory_most_bytes": null' out || fail "0 B of memory"
expect 0 "$clast" explain mark.yaml
prints "runs the program: sh mark.sh {{a}} {{seed}}"; prints "A number"
[ ! -e touched ] || fail "a program was run without the user's word"
expect 0 "$clast" simulate mark.yaml $word
[ -e touched ] || fail "the program was not run with the user's word"
! grep -q "M_1/M" out || fail "a program without fragments has a largest one"
expect 0 "$clast" run mark-runs.yaml $word
expect 0 "$clast" estimates mark.db
grep -qE " 1 +1 +- " out || fail "a program without fragments has a largest one in a table"
rm touched
expect 64 "$clast" replay mark.db 1
expect 0 "$clast" report mark.db
expect 0 "$clast" merge mark2.db mark.db
expect 0 "$clast" check mark2.db
[ ! -e touched ] || fail "a store ran a program without the user's word"

expect 65 "$clast" plan mark.yaml
says "mark.yaml is a scene, not a campaign"; one_error
expect 0 "$clast" converge mark-runs.yaml --list
says "fewer than two named settings"
expect 0 "$clast" converge mark.yaml --list --csv
same "$(cut -d, -f2 out | tr '\n' ' ')" "knob a " "knobs of the scene alone"

# ---- a program without the seed, and one without an element, say so before a run ----
expect 0 "$clast" run mark-runs.yaml $word
! grep -q "warning" err || fail "a program with its seed is warned of"
sed 's/, "{{seed}}"//; s/^  results:/  fragments: {name: m}\n&/' mark.yaml >deaf.yaml
sed 's/mark/deaf/' mark-runs.yaml >deaf-runs.yaml
expect 0 "$clast" plan deaf-runs.yaml
prints "all seeds are the same run"; prints "the lightest fragment of each run counts as its element"
rm -f touched

# ---- scenes that are wrong ----
sed 's/  version: .*//' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "command.version: is missing"
sed 's/{{a}}/{{b}}/' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "{{b}} is no input of the command"; says "wrong.yaml:6:"
sed 's/files: .*/templates: {in.txt: "{{b}}"}/' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "command.templates: {{b}} is no input of the command"
sed 's/doc: A result/unit: km, doc: A result/' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "SI unit without prefix"
sed 's/{x: {/{largest_fraction: {/' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "is a word of clast"
sed 's/files: .*/files: [none.sh]/' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "none.sh"
sed 's|files: .*|files: [../mark.sh]|' mark.yaml >wrong.yaml
mkdir -p below && cp wrong.yaml below
expect 65 "$clast" explain below/wrong.yaml
says "there is no file ../mark.sh in the folder of the scene"
ln -s ../mark.sh below/link.sh
sed -i 's|files: .*|files: [link.sh]|' below/wrong.yaml
expect 65 "$clast" explain below/wrong.yaml
sed 's|"{{a}}"|"\\e[2K\\rinnocent"|' mark.yaml >wrong.yaml
expect 65 "$clast" explain wrong.yaml
says "control character"
printf 'echo \033[2Kinnocent\n' >below/bad.sh
sed -i 's|files: .*|files: [bad.sh]|' below/wrong.yaml
expect 65 "$clast" explain below/wrong.yaml
says "no plain text"
printf 'echo é\r\n\techo\n' >below/bad.sh
expect 0 "$clast" explain below/wrong.yaml
expect 0 "$clast" explain command
prints "limits.output"
sed 's/program: sh/program: no-such-program/' mark.yaml >wrong.yaml
expect 66 "$clast" simulate wrong.yaml $word
says "no-such-program is in no folder of PATH"
expect 65 "$clast" simulate mark.yaml $word --set program.version=2
says "follow from the scene's section"
expect 64 "$clast" simulate mark.yaml $word --set a=101
says "at most 100"
expect 64 "$clast" simulate mark.yaml $word --fields x.h5
says "has no fields"
(echo 'keep: {fields: all}'; cat mark-runs.yaml) >keep.yaml
expect 65 "$clast" run keep.yaml $word

# ---- a spectrum of whole grains, N(>= k) = 1 / (k - 1/2), complete from five: its exponent is 2 ----
for element in "element_mass: 0.1 kg, " ""; do # without it: the lightest fragment
  scene grains "fragments: {name: m, unit: kg, ${element}complete_mass: 0.5 kg}" <<'SH'
awk 'BEGIN { for (i = 0.5; i < 3000; i++) m = m sprintf(", %.17g", 0.1 * int(0.5 + 1500 / i)); print "{\"x\": 1, \"m\": [" substr(m, 2) "]}" }'
SH
  rm -f grains.db
  expect 0 "$clast" simulate grains.yaml $word
  ! grep -q "grain or particle" out || fail "a program without particles has particles"
  [ -n "$element" ] && prints "of one element" || prints "element_mass"
  expect 0 "$clast" run grains-runs.yaml $word
  number grains.db "select abs(complete_mass - 0.55) < 1e-12 and abs(beta - 2) < 0.03 from run natural join estimate where method = 'masses' and window = 'from_5'" >right
  same "$(cat right)" 1 "window and exponent of whole grains"
done

# A flat spectrum: the numbers above a mass are no power law, so tables for people have no exponent of them.
scene flat 'fragments: {name: m, unit: kg}' <<'SH'
awk 'BEGIN { for (i = 1; i < 300; i++) m = m sprintf(", %.17g", 1 + (i / 30) ^ 3); print "{\"x\": 1, \"m\": [" substr(m, 2) ", 2000]}" }'
SH
expect 0 "$clast" run flat-runs.yaml $word
expect 0 "$clast" exponents flat.db --draws 100
says "numbers above a mass follow no power law"
same "$(awk '$1 == 1 {print $6, $8}' out)" "- -" "exponents of a flat spectrum"
expect 0 "$clast" run grains-runs.yaml --seeds 2 $word
expect 0 "$clast" exponents grains.db --draws 100
! grep -q 'follow no power law' err || fail "an exponent of 2 is called flat"
says "~: no interval, all runs are equal"; grep -q ' 2.01~ ' out || fail "no mark at an exponent without an interval"
says "does not know the dimensions of a program's model (--dimensions 2 or 3)"
expect 0 "$clast" exponents grains.db --draws 100 --csv
same "$(sed -n 2p out | cut -d , -f 9-11)" ",," "exponents by size in unknown dimensions"
for d in 2 3; do
  expect 0 "$clast" exponents grains.db --draws 100 --csv --dimensions $d
  same "$(awk -F , -v d=$d 'NR == 2 {print ($10 - d * ($6 - 1)) ^ 2 < 1e-4}' out)" 1 "exponent by size in $d dimensions"
done
expect 64 "$clast" spectrum grains.db --size '2700 kg/m^3'
says "add --dimensions 2 or --dimensions 3"
for d in 2 3; do # the lightest, of 0.1 kg: a disc of L^2 = 4 m / (pi density), a sphere of L^3 = 6 m / (pi density)
  expect 0 "$clast" spectrum grains.db --size '1000 kg/m^3' --dimensions $d --csv
  same "$(awk -F , -v d=$d 'NR == 2 {print ($2 ^ d / (2 * d * 0.1 / (1000 * atan2(0, -1))) - 1) ^ 2 < 1e-12}' out)" 1 "size in $d dimensions"
done
# A power law that ends at 20 kg: windows that end at the largest fragment hide it.
scene ends 'fragments: {name: m, unit: kg}' <<'SH'
awk 'BEGIN { for (i = 0.5; i < 2000; i++) m = m sprintf(", %.17g", 1 / (i / 2000 + 0.05)); print "{\"x\": 1, \"m\": [" substr(m, 2) ", 19, 19.2, 19.4, 19.6]}" }'
SH
expect 0 "$clast" run ends-runs.yaml $word
expect 0 "$clast" exponents ends.db --draws 100 --json # a cut-off that only the largest fragments show
python -c "import json; row, = json.load(open('out')); assert row['cutoff_p'] == 1 and row['open_cutoff_p'] < 1e-6, row"

# ---- inputs, templates, units, results ----
scene all 'templates: {in.txt: "speed {{speed}} law {{law}} wet {{wet}} n {{n}} seed {{seed}} {{small_seed}} {brace} ${{speed}}"}' \
  'results: {x: {unit: J, written_in: kJ, name: deep.x, doc: A.}, y: {doc: B.}}' 'output: out.json' \
  'fragments: {file: masses.csv, name: m, unit: g, element_mass: 0.001 kg}' <<'SH'
cat in.txt >&2
env | sort | sed "s|$PWD|HERE|" >&2
printf '{"deep": {"x": 1.5}, "y": null}' >out.json
printf 'id,m\n1,4\n2,1\n3,15\n' >masses.csv
exit 3
SH
sed -i 's/inputs: {/inputs: {speed: {unit: m\/s, written_in: km\/s, default: 5 km\/s, doc: S.}, law: {kind: choice, choices: [soft, hard], default: hard, doc: L.}, wet: {kind: switch, default: true, doc: W.}, n: {kind: count, default: 7, doc: N.}, /' all.yaml
expect 1 "$clast" simulate all.yaml $word --seed 900000123
says "ended with exit code 3"
says "TZ=UTC"
sed -i 's/^exit 3/exit 0/; s/^env.*//' all.sh
sed -i 's/^cat in.txt.*/cat in.txt >lines; grep -qxF "speed 5 law hard wet true n 7 seed 900000123 125 {brace} $""5" lines || exit 4/' all.sh
expect 0 "$clast" simulate all.yaml $word --seed 900000123 --json
python - <<'PY'
import json
row = json.load(open('out'))[0]
assert row['x'] == 1500 and row['fragment_count'] == 3 and row['single_count'] == 1, row
assert abs(row['total_mass'] - 0.02) < 1e-15 and row['largest_fraction'] == 0.75, row
PY
ok "units, keys, columns and masses"

# ---- bad programs ----
# bad NAME REASON WORDS [LINE...]: one run says WORDS; in a campaign it is an attempt that failed for REASON.
bad() {
  local name=$1 reason=$2 words=$3
  shift 3
  scene "$name" "$@"
  expect 1 "$clast" simulate "$name.yaml" $word
  says "$words"
  one_error
  nothing_left "$name"
  expect 1 "$clast" run "$name-runs.yaml" $word
  says "points: 1 of 1 ended"
  same "$(number "$name.db" 'select reason from attempt')" "$reason" "$name"
  "$clast" query "$name.db" --named failures >out
  ! grep -q "(exit 1)" out || fail "an exit code of clast is told as the program's"
  nothing_left "$name"
}
bad hang time_limit "did not end within 1 s" 'limits: {time: 1 s}' <<'SH'
trap '' TERM INT HUP
setsid sleep 1000 &
sleep 1001
SH
bad crash crash "killed by signal 11" <<'SH'
kill -SEGV $$
SH
bad code exit "its last words: 'no licence'" <<'SH'
echo no licence >&2
exit 7
SH
bad hello exit "is no JSON: it begins with 'hello world'" <<'SH'
echo hello world
SH
bad garbage exit "is no JSON" <<'SH'
head -c 3000 /dev/urandom
SH
bad prose exit "expected a number for x, got 'about two'" <<'SH'
echo '{"x": "about two"}'
SH
bad keyless exit "has no key \`x\` for the result x; its keys: y" <<'SH'
echo '{"y": 2}'
SH
bad columns exit "has no column \`x\`" 'output: out.csv' <<'SH'
printf 'y,z\n1,2\n' >out.csv
SH
bad twice exit "x: given twice; the first is in line 1" <<'SH'
echo '{"x": 1, "x": 2}'
SH
bad doubled exit "out.csv has two columns \`x\`" 'output: out.csv' <<'SH'
printf 'x,y,x\n1,2,3\n' >out.csv
SH
bad ragged exit "out.csv, line 3" 'output: out.csv' <<'SH'
printf 'x,z\n1,2\n3\n' >out.csv
SH
bad flood exit "limits: output" <<'SH'
exec head -c 1000000000 /dev/zero
SH
bad none exit "wrote no file out.json" 'output: out.json' <<'SH'
exit 0
SH
bad silent exit "its last words: 'cannot read the mesh'" <<'SH'
echo cannot read the mesh >&2
SH
bad sorry exit "has the key \`error\`: no convergence" <<'SH'
echo '{"error": "no convergence", "x": 1}'
SH
bad link exit "wrote no file out.json" 'output: out.json' <<'SH'
ln -s /etc/passwd out.json
SH
bad fifo exit "is no plain file" 'output: out.json' <<'SH'
mkfifo out.json
SH
bad mass exit "which is not above 0" 'fragments: {file: m.txt}' <<'SH'
echo '{"x": 1}'; echo '3 2 -1' >m.txt
SH
for value in NaN -Infinity 1e999; do
  scene nan <<SH
echo '{"x": $value}'
SH
  rm -f nan.db
  expect 1 "$clast" run nan-runs.yaml $word --quiet
  same "$(number nan.db 'select state from run')" not-finite "$value"
done
scene states 'exit_codes: {3: end-time, 4: invalid}' <<'SH'
echo '{"x": 1}'
echo "code $1" >&2
exit "$1"
SH
expect 0 "$clast" simulate states.yaml $word --set a=3 --json
prints end-time
expect 1 "$clast" simulate states.yaml $word --set a=4
says "code 4"

# Children of a program end with it, and the program with clast, also if clast is killed.
scene orphan <<SH
(trap '' TERM HUP; setsid sleep 998.5) >/dev/null 2>&1 &
sleep 0.2
echo '{"x": 1}'
SH
expect 0 "$clast" simulate orphan.yaml $word
! pgrep -f 'sleep 998.5' >out || fail "a child of the program goes on"
scene killed <<'SH'
sleep 997.5
SH
"$clast" simulate killed.yaml $word >/dev/null 2>&1 &
pid=$!
for _ in $(seq 100); do pgrep -f 'sleep 997.5' >/dev/null && break; sleep 0.1; done
kill -KILL $pid
wait $pid || true
for _ in $(seq 100); do pgrep -f 'sleep 997.5' >/dev/null || [ -n "$(ls tmp)" ] || break; sleep 0.1; done
! pgrep -f 'sleep 997.5' >out || fail "the program outlives clast"
for _ in $(seq 100); do [ -z "$(ls tmp)" ] && break; sleep 0.1; done
nothing_left "clast killed"
ok "programs end with clast"
scene longer <<'SH'
(setsid sleep 996.5) &
sleep 996.5
SH
sed -i 's/attempts: 1/attempts: 1, time: 1 s/' longer-runs.yaml
expect 1 "$clast" run longer-runs.yaml $word --quiet
same "$(number longer.db 'select reason from attempt')" time_limit "the campaign's limit"
for _ in $(seq 100); do [ -z "$(ls tmp)" ] && break; sleep 0.1; done
nothing_left "the campaign's limit"
! pgrep -f 'sleep 996.5' >out || fail "a program outlives the campaign's limit"

# ---- runs without a result, failed (a: 3) or died (a: 9), are told wherever there are means ----
scene gone 'exit_codes: {3: not-finite}' <<'SH'
echo "{\"x\": $2}"
[ "$1" = 2 ] || [ $(($2 % 2)) = 0 ] || exit "$1"
SH
sed -i 's/per_point: 1/per_point: 6/; $a vary: {a: [2, 3, 9]}' gone-runs.yaml
expect 1 "$clast" run gone-runs.yaml $word --quiet
expect 0 "$clast" estimates gone.db --csv
same "$(grep -v from_[51] out | cut -d, -f3,4 | tr '\n' ' ')" "n,failed 6,0 3,3 3,3 " "runs of estimates"
expect 0 "$clast" stats gone.db -Q x --by a --csv
same "$(cut -d, -f5,6 out | tr '\n' ' ')" "n,failed 6,0 3,3 3,3 " "runs of means"
expect 0 "$clast" stats gone.db -Q x --where 'seed > 3' --by a --csv
same "$(cut -d, -f5,6 out | tr '\n' ' ')" "n,failed 3,0 2,1 2,0 " "runs that died are in no choice of runs"
expect 0 "$clast" stats gone.db -Q x --where 'x > 0' --by a --csv # all runs of a: 9 that there are
same "$(cut -d, -f5,6 out | tr '\n' ' ')" "n,failed 6,0 3,0 3,0 " "runs that died, if all others are chosen"
for command in "estimates gone.db" "stats gone.db -Q x" "scatter gone.db -Q x" "sensitivity gone.db -Q x" \
  "plot gone.db gone.png -Q x" "report gone.db" "run gone-runs.yaml --quiet $word"; do
  "$clast" $command >out 2>err || [ "${command%% *}" = run ] || fail "$command"
  says "6 of 18 runs gave no result"
done
for picture in "plot gone.db one.png" "scatter gone.db --picture one.png"; do # so does the picture itself
  "$clast" $picture -Q x --keep-script >out 2>err || fail "$picture"
  grep '^caption_text' one.gp | sed "s/'\.\"\\\\n\"\.'/ /g" | grep -q "6 of 18 runs gave no result" || fail "no caption: $picture"
done
for point in 2 3; do
  expect 0 "$clast" compare gone.db:1 gone.db:$point -Q x
  says "3 of 6 runs gave no result"
done
expect 0 "$clast" converge gone.yaml --knob a=4,6 -Q x --seeds 6 --within off --store gone.db $word # of its own runs alone
says "6 runs gave no result"
sed -i 's/a: \[2, 3, 9\]/a: [2, 4]/; s/^name: gone/name: all/' gone-runs.yaml # no run of a: 4 has a result
sed 's/\$((\$2 % 2))/1/' gone.sh >all.sh && sed 's/gone/all/g' gone.yaml >all.yaml && sed 's/gone/all/g' gone-runs.yaml >all-runs.yaml
expect 1 "$clast" run all-runs.yaml $word --quiet
expect 0 "$clast" stats all.db -Q x --by a --csv
same "$(cut -d, -f1,5,6 out | tr '\n' ' ')" "a,n,failed 2,6,0 4,0,6 " "a point without a result"

# ---- a campaign: the same bits in any way of computing, statistics, resuming ----
sed 's/per_point: 20/per_point: 6/; s/^name: .*/name: one/' strengths.yaml >one.yaml
expect 0 "$clast" run one.yaml $word -j 1
"$clast" export one.db reference.bits --bits
expect 0 "$clast" run one.yaml $word --store two.db -j 2 --in-process
same_bits two.db reference.bits "in process"
expect 0 mpirun -n 3 "$clast" run one.yaml $word --store mpi.db --quiet
same_bits mpi.db reference.bits "three ranks"
expect 0 "$clast" run one.yaml $word
says "0 runs computed"
expect 0 "$clast" stats one.db --quantity strength --by modulus --json
python - <<'PY'
import json
rows = json.load(open('out'))
assert len(rows) == 3, rows
means = [r['strength_mean'] for r in rows]
assert means == sorted(means), means # less scatter of the fibres, more strength
PY
ok "means over seeds"
expect 0 "$clast" simulate bundle.yaml $word
[[ $(sed -n 2p out) == "strength "* ]] || fail "the main quantity is the first result that the scene names"
ok "the scene's own result stands first"
expect 0 "$clast" spectrum one.db
expect 0 "$clast" report one.db
expect 0 "$clast" replay one.db 5 $word
says "agree to the last bit"
expect 0 "$clast" converge bundle.yaml $word --quantity strength --max-seeds 8 --within off
prints "fibres"
# A program whose seeds scatter alike at all levels: a bias is told seed by seed, as `compare` tells it, so that few seeds do.
scene twins <<'SH'
awk -v a="$1" -v s="$2" 'BEGIN { printf "{\"x\": %.17g}", s * 7919 % 101 + (1 + s % 3) / a }'
SH
expect 0 "$clast" converge twins.yaml $word --knob a=1,2,4,8 -Q x --seeds 6 --max-seeds 24 --within 1 --store twins.db
same "$(number twins.db 'select max(n), sum(paired), max(bias_half_width) < 1, min(half_width) > 10 from convergence where n > 0')" \
  "6,4,1,1" "biases seed by seed"
# The processor time of a run is that of the program, wherever it is computed.
scene busy <<'SH'
python3 -c 'import time
while time.process_time() < 0.2: pass'
echo '{"x": 1}'
SH
for way in "" --in-process; do
  rm -f busy.db
  expect 0 "$clast" run busy-runs.yaml $word $way
  same "$(number busy.db 'select cpu_time >= 0.2 from run')" 1 "processor time $way"
done
# Time that is over in the middle of a round: only the first seed is quick.
scene slow <<'SH'
[ "$2" = 1 ] || sleep 1
echo "{\"x\": $1}"
SH
expect 0 "$clast" converge slow.yaml $word --knob a=1,2 -Q x --seeds 4 --max-seeds 4 --within off --seconds 3 -j 1
[ "$(number slow-converge.db 'select count(*) from run')" -lt 8 ] || fail "a round goes on when the time is over"
(sed 's/^name: .*/name: search/; s/modulus: .*/modulus: {from: 1.5, to: 10, n: 2}}/; s/quantity: .*//' one.yaml; echo 'set: {fibres: 300}') >search.yaml
expect 0 "$clast" find search.yaml $word --quantity strength --level 0.5 --within 40%
prints "rises through 0.5"
"$clast" serve search.yaml $word --port 0 -Q strength >/dev/null 2>serve.err &
pid=$!
for _ in $(seq 100); do grep -q 'at port' serve.err && break; sleep 0.1; done
python - "$(sed -n 's/.*at port \([0-9]*\).*/\1/p' serve.err)" <<'PY'
import json, sys, urllib.request
ask = json.dumps({'name': 'search', 'input': [[3.0]], 'config': {}}).encode()
answer = json.load(urllib.request.urlopen(f'http://127.0.0.1:{sys.argv[1]}/Evaluate', ask, timeout=60))
assert 0.3 < answer['output'][0][0] < 0.7, answer
PY
kill -TERM $pid
wait $pid || true
ok "a server of models"
sed -i 's/  version: "1"/  version: "2"/' bundle.yaml
expect 0 "$clast" run one.yaml $word
same "$(number one.db 'select count(*) from point')" 6 "another version, other points"
expect 0 "$clast" check one.db

# A program that promises no bits is no fault in replay.
scene dice <<'SH'
echo "{\"x\": $(date +%N | sed 's/^0*//')}"
SH
expect 0 "$clast" run dice-runs.yaml $word
expect 0 "$clast" replay dice.db 1 $word
says "promises no bits"

# Two scenes in one store: their results are columns of one table. One name has one unit.
scene length 'results: {x: {unit: m, doc: A length.}}' <<'SH'
echo '{"x": 1}'
SH
expect 65 "$clast" run length-runs.yaml $word --store dice.db
says "unit"
scene more 'results: {x: {doc: As before.}, z: {unit: m, doc: Another.}}' <<'SH'
echo '{"x": 1, "z": 2}'
SH
expect 0 "$clast" run more-runs.yaml $word --store dice.db
expect 0 "$clast" check dice.db
expect 0 "$clast" merge mark.db dice.db
expect 0 "$clast" check mark.db
same "$(number mark.db 'select sum(z) from runs')" 2 "columns of merged stores"
done_after 182
