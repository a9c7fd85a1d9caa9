# Results in doubt: every command that prints a number of a store marks one that rests on runs beyond the bound of a condition,
# and says how many runs and what to do. A command that is not in the list below fails this test.
. "$(dirname "$0")/lib.bash"

# Half of the points have a time step that marks every result; both halves have numbers.
cat >marked.yaml <<'YAML'
name: marked
scene: disc-explosion
set: {body.diameter: 14 cm, charge.energy: 6 kJ/m, stop.least_time: 1 ms}
vary: {fidelity.time_step: [1 us, 4 us], threshold.strain: [2 %, 5 %]}
seeds: {per_point: 3}
YAML
cat >unknown.yaml <<'YAML'
name: unknown
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.least_time: 1 ms, fidelity.time_step: 4 us}
vary: {threshold.strain: {log_uniform: [1 %, 8 %]}}
design: {kind: latin_hypercube, points: 8, seed: 3}
seeds: {per_point: 3}
store: unknown.db
YAML
cat >measured.yaml <<'YAML'
name: one
source: made up for this test
shots:
  - name: a
    measured:
      - {quantity: largest_fraction, value: 0.3, error: 0.05, resolution: 0.02}
YAML
cat >sweep.yaml <<'YAML'
name: sweep
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.least_time: 1 ms, fidelity.time_step: 4 us}
vary: {threshold.strain: {uniform: [1 %, 6 %]}, threshold.angle: {uniform: [2 deg, 6 deg]}}
design: {kind: sobol, points: 4}
seeds: {per_point: 2}
YAML
printf '# source: made up\nmass (kg), count\n0.5, 3\n2, 1\n' >measured.csv
expect 0 "$clast" run marked.yaml --store marked.db -j 2
says "12 of 12 runs" # the progress line
says "6 runs warned, 6 of them in doubt in largest_fraction (!)"
# Conditions that leave the main quantity alone: `clast status` counts the same runs.
printf '%s\n' 'name: ball' 'scene: basalt-sphere' 'quantity: energy_error' 'seeds: {per_point: 2}' \
  'set: {fidelity.particles: 300, stop.end_time: 40 us, fidelity.precision: float}' >ball.yaml
expect 0 "$clast" run ball.yaml --store ball.db -j 2
says "2 runs warned, 0 of them in doubt in energy_error (!)"
expect 0 "$clast" status ball.db --json
prints '"warned": 2'
sed 's/1 us, 4 us/4 us/; s/per_point: 3/per_point: 12/' marked.yaml >each.yaml # any line of progress is of marked runs
expect 0 "$clast" run each.yaml --store each.db -j 1
grep -q 'largest_fraction 0.[0-9]* !' err || fail "the mean of the progress line is not marked"
expect 0 "$clast" sensitivity sweep.yaml ask.yaml --design saltelli --blocks 4
expect 0 "$clast" run ask.yaml --store ask.db -j 2 --quiet

# What a person sees: " !" behind a number, and below the table the runs, the word, and where to read the reason and the remedy.
marked() { # marked RUNS COMMAND...
  local runs=$1
  shift
  expect 0 "$clast" "$@"
  grep -Eq '[0-9s)] !( |$)' out || fail "no mark: $*"
  says "marked (!), $runs runs: step: fidelity.time_step over the longest stable step is above 0.25 (clast explain step)"
  same "$(grep -c 'marked (!)' err)" 1 "sentences"
}
# What a program gets: the number of runs and their words, in rows that rest on them, and in no others.
columns() { # columns SOUND COMMAND...: SOUND 1: some rows are sound
  expect 0 "$clast" "${@:2}" --csv
  python - "$1" <<'PY' || fail "columns of doubts: ${*:2}"
import csv, sys
rows = list(csv.DictReader(open("out", newline="")))
assert list(rows[0])[-1] == "doubts", list(rows[0])
count = [k for k in rows[0] if k.endswith("doubtful")]
assert count and {r["doubts"] for r in rows} == ({"", "step"} if sys.argv[1] == "1" else {"step"}), rows
assert all((int(r[k]) > 0) == (r["doubts"] == "step") for r in rows for k in count), rows
PY
  expect 0 "$clast" "${@:2}" --json
  python -c 'import json; assert any(r["doubts"] == "step" for r in json.load(open("out")))' || fail "JSON: ${*:2}"
}
caption() { # caption NAME COMMAND...: the picture NAME.png marks a value or a name, and its caption says why
  expect 0 "$clast" "${@:2}" --keep-script
  grep '^caption_text' "$1.gp" | sed "s/'\.\"\\\\n\"\.'/ /g" | grep -q "! in doubt, .* runs: step" || fail "no caption: ${*:2}"
}

for command in $("$clast" help | awk '/:$/ {group = $0} /^  [a-z]/ && group != "first steps:" {print $1}'); do
  case $command in
  run) marked "6 of 12" run marked.yaml --store marked.db
    columns 1 run marked.yaml --store marked.db ;;
  estimates) marked "6 of 12" estimates marked.db
    columns 1 estimates marked.db ;;
  exponents) marked "3 of 3" exponents marked.db --point 3 --draws 100
    columns 1 exponents marked.db --draws 100 ;;
  stats) marked "6 of 12" stats marked.db --by time_step,strain -Q main
    columns 1 stats marked.db --by time_step ;;
  scatter) marked "6 of 12" scatter marked.db
    columns 1 scatter marked.db
    caption s scatter marked.db --picture s.png ;;
  sensitivity) marked "32 of 32" sensitivity ask.db ask.yaml -Q fragment_count
    columns 0 sensitivity ask.db ask.yaml -Q fragment_count ;;
  scaling) columns 0 scaling marked.db --size strain --control time_step ;; # marks and a caption: cli.scaling
  spectrum) marked "6 of 12" spectrum marked.db
    columns 1 spectrum marked.db
    columns 1 spectrum marked.db --runs
    marked "6 of 12" spectrum marked.db --with measured.csv
    columns 1 spectrum marked.db --with measured.csv
    caption f spectrum marked.db --picture f.png ;;
  compare) marked "3 of 6" compare marked.db:1 marked.db:3
    columns 0 compare marked.db:1 marked.db:3 ;;
  plot) caption p plot marked.db p.png --x time_step --by strain
    same "$(grep -c ' 1$' p.dat)" 2 "marked means" ;;
  map) caption m map marked.db m.png --x time_step --y strain
    same "$(awk 'NF == 7 && $4 == 1' m.dat | wc -l)" 2 "marked tiles" ;;
  converge) study=(converge disc-explosion --set body.diameter='8 cm' --set charge.energy='2 kJ/m' --set stop.least_time='1 ms'
    --knob time_step=4us,1us --seeds 2 --within off --store study.db --quiet)
    marked "2 of 4" "${study[@]}"
    columns 1 "${study[@]}" ;;
  find) search=(find unknown.yaml --level 0.25 --max-runs 20 --store found.db --quiet)
    marked "18 of 20" "${search[@]}"
    columns 0 "${search[@]}"
    caption o "${search[@]}" --picture o.png ;;
  fit) marked "60 of 71" fit measured.yaml unknown.yaml --rounds 3 --quiet
    columns 0 fit measured.yaml unknown.yaml --rounds 3 --quiet
    caption q fit measured.yaml unknown.yaml --rounds 3 --quiet --picture q.png ;;
  status) expect 0 "$clast" status marked.db --json
    python -c 'import json; assert json.load(open("out"))[0]["warned"] == 6' || fail "status" ;;
  extremes) expect 0 "$clast" extremes marked.db --why
    prints "step" ;;
  simulate) expect 0 "$clast" simulate disc-explosion --set fidelity.time_step='4 us' --set stop.end_time='20 us'
    grep -q '^M_1/M .* !' out || fail "simulate" ;;
  plan) expect 0 "$clast" plan marked.yaml --no-trial
    cat out err | grep -q "2 of 4 points: step: fidelity.time_step" || fail "plan does not tell the condition" ;;
  explain) expect 0 "$clast" explain step
    prints "0.25." ;;
  report) ;; # cli.report looks at the page
  # raw values, with the words beside them: clast query, clast export
  query) ;;
  export) expect 0 "$clast" export marked.db --per point
    python - <<'PY' || fail "rows of points" ;;
import csv
assert [(r["doubtful"], r["doubts"]) for r in csv.DictReader(open("out", newline=""))] == [("0", "")] * 2 + [("3", "step")] * 2
PY
  picture) expect 0 "$clast" simulate disc-explosion --set fidelity.time_step='4 us' --set stop.end_time='20 us' --fields body.hdf
    expect 0 "$clast" picture body.hdf body.png
    says "marked (!), 1 of 1 runs: step: fidelity.time_step over the longest stable step is above 0.25" ;;
  serve) "$clast" serve marked.yaml --store marked.db --port 0 2>serve.err &
    pid=$!
    for _ in $(seq 200); do
      port=$(sed -nE 's/^clast: serving at port ([0-9]+) .*/\1/p' serve.err)
      [ -z "$port" ] || break
      sleep 0.05
    done
    for step in 1e-6 4e-6; do
      python - "$port" $step >answer <<'PY'
import json, sys, urllib.request
body = {"name": "marked", "input": [[float(sys.argv[2]), 0.02]]}
print(urllib.request.urlopen(f"http://127.0.0.1:{sys.argv[1]}/Evaluate", json.dumps(body).encode(), timeout=60).read().decode())
PY
      [ "$(grep -c 'marked (!), 3 of 3 runs: step: fidelity.time_step over' answer)" = $([ $step = 4e-6 ] && echo 1 || echo 0) ] ||
        fail "doubts of an answer at $step"
    done
    kill $pid
    wait $pid || true ;;
  # no numbers of a store that rest on runs: files, bits, other programs
  retry | scenes | materials | schema | cite | exclude | check | merge | replay | help | version | completion) ;;
  *) fail "clast $command is new: does it print a number that may be in doubt?" ;;
  esac
done

# Withheld: "-" where no run has a meaning; where some have one, the mean is theirs, and their number stands beside it.
cat >withheld.yaml <<'YAML'
name: withheld
scene: compression
set: {body.columns: 8, body.rows: 12}
vary: {loading.strain_end: [2 %, 6 %]}
seeds: {per_point: 3}
store: withheld.db
YAML
expect 0 "$clast" run withheld.yaml -j 2 --quiet
expect 0 "$clast" stats withheld.db -Q strength --by strain_end
says "withheld, 3 of 6 runs: event: the last stress over the largest one is above 0.9"
expect 0 "$clast" plot withheld.db strength.png -x strain_end -Q strength --keep-script
grep -q '^caption_text.*withheld, 3 of 6 runs: event' strength.gp || fail "a caption without the runs that are not drawn"
! grep -q 'in doubt.*event' strength.gp || fail "a withheld run counts among those that are drawn"
expect 0 "$clast" stats withheld.db -Q strength --by strain_end --csv
python - <<'PY' || fail "withheld"
import csv
few, enough = csv.DictReader(open("out", newline=""))
assert few["strength_mean"] == "" and few["strength_n"] == "0" and few["strength_doubtful"] == "3" and few["doubts"] == "event, elastic"
assert float(enough["strength_mean"]) > 2e7 and enough["strength_n"] == "3" and enough["doubts"] == ""
PY
expect 0 "$clast" stats withheld.db -Q strength
grep -Eq ' [0-9.×^()]+ \(3\) !' out || fail "a mean of three of six runs"
expect 0 "$clast" query withheld.db "select count(strength), sum(withheld(engine, warnings, 'strength')), (select count(strength) from result_dem) from runs" --csv
prints "3,3,6" # the store keeps the raw values
! grep -q "in doubt" err || fail "a question about the words is told of them"
expect 0 "$clast" query withheld.db "select avg(strength) from runs"
says "3 runs of this store have a result in doubt: see columns doubtful and warnings of the view runs"
printf 'name: liquid\nquantity: ejecta.mass_fraction\nscene: disruption\nset: {fidelity.particles: 300, fidelity.projectile_spacing: 0.5, stop.end_time: 9 us}\nvary: {target.strength: [true, false]}\nseeds: {per_point: 2}\nstore: liquid.db\n' >liquid.yaml
expect 0 "$clast" run liquid.yaml -j 2 --quiet
same "$(number liquid.db "select (select count(*) from run where largest_fraction >= 0) || ' ' || (select count(largest_fraction) from runs) || ' ' || count(largest_fraction_mean) || ' ' || count(largest_fraction_sd) || ' ' || count(mean_fragment_mass_mean) from points")" "4 2 1 1 2" "a main result that is withheld"
# No ready question shows such a value: the table gets one that would be seen.
cp liquid.db raw.db
python - "$clast" <<'PY' || fail "a ready question shows a value that is withheld, or a run that is excluded"
import json, sqlite3, subprocess, sys
with sqlite3.connect("raw.db") as db:
    db.execute("UPDATE run SET largest_fraction = 0.424242, state = 'end-time' WHERE instr(warnings, 'liquid')")
def ask(*words):
    return subprocess.run([sys.argv[1], "query", *words], capture_output=True, text=True, check=True).stdout
shown = {}
for query in json.loads(ask("--list", "--json")):
    given = [f"--with={name}={3 if name == 'run' else 2}" for name in query["with"].replace(",", " ").split()]
    shown[query["name"]] = "0.424242" in ask("raw.db", "--named", query["name"], *given, "--csv")
assert len(shown) > 12 and not any(shown.values()), shown
stats, censored = (json.loads(ask("raw.db", "--named", name, "--json")) for name in ("point-stats", "censored"))
assert [row["mean"] is None for row in stats] == [False, True] and [row["n"] for row in stats] == [2, 2], stats
assert [row["largest_fraction"] is None for row in censored] == [row["point_id"] == 2 for row in censored] == [False, False, True, True], censored
subprocess.run([sys.argv[1], "exclude", "raw.db", "1", "--reason", "a test"], capture_output=True, check=True)
assert {row["run_id"] for row in json.loads(ask("raw.db", "--named", "censored", "--json"))} == {2, 3, 4}
PY
ok "ready questions and withheld values"
expect 0 "$clast" merge kinds.db withheld.db liquid.db # masses per metre beside others
expect 0 "$clast" stats kinds.db
grep -q "largest_fraction" out || fail "the default is a quantity that most runs lack: $(head -2 out)"
expect 0 "$clast" query kinds.db "select finished_at from runs limit 1"
grep -qE "^ *20..-..-..T..:..:..Z$" out || fail "a date in seconds: $(cat out)"
expect 0 "$clast" query kinds.db "select engine, total_mass from runs"
grep -q 'total_mass *$' out || fail "one unit for masses of two kinds"
expect 0 "$clast" query liquid.db "select energy_kinetic, energy_input from runs" # of dem in J/m
grep -qF 'energy_kinetic [J]  energy_input [J]' out || fail "energies of sph in another unit: $(head -1 out)"
same "$(number liquid.db "select group_concat(unit) from column_doc where table_name = 'runs' and column_name like 'energy_kinetic%'")" J "unit in the store"
same "$(PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$source/python" python -c "import clast; print(clast.open('liquid.db').unit('energy_kinetic'))")" J "unit in Python"
expect 64 "$clast" compare withheld.db:1 withheld.db:2 -Q strength
says "no run that counts has a value of strength that is not withheld"
ok "withheld values"

# A block whose beams cannot break has moduli, and no strength. Runs that are all equal have no interval, and nothing is
# concluded from that.
printf 'name: even\nscene: uniaxial\nset: {body.columns: 6, body.rows: 8, grain.disorder: 0}\nvary: {loading.direction: [%s]}\nseeds: {per_point: 2}\nstore: even.db\n' \
  "extension, compression" >even.yaml
expect 0 "$clast" run even.yaml -j 2 --quiet
expect 0 "$clast" stats even.db -Q strength
says "withheld, 4 of 4 runs: elastic: no beam of the block broke"
same "$(number even.db "select sum(doubtful) || ' of ' || (select count(*) from runs where warnings = 'elastic') from points")" "0 of 4" "sound runs"
expect 0 "$clast" stats even.db -Q young_modulus --by loading.direction
! grep -q '!\|±' out || fail "a mark or an interval"
says "intervals are over seeds (95 %; none where all are equal to 14 digits)"
expect 0 "$clast" compare even.db:1 even.db:2 -Q young_modulus
says "no interval where all runs, or all differences, are equal"
expect 64 "$clast" sensitivity even.db -Q strength
! grep -q 'no effect' err || fail "an input that acts"
ok "equal runs"

# A file has no number where a result is withheld: a disc whose dust is less than two particles.
cat >dust.yaml <<'YAML'
name: dust
scene: disruption
set: {fidelity.particles: 300, stop.end_time: 20 us}
vary: {impact.angle: [0 deg, 30 deg]}
seeds: {per_point: 1}
store: dust.db
YAML
expect 0 "$clast" run dust.yaml -j 2 --quiet
expect 0 "$clast" plot dust.db one.png --keep-script
grep -q '^title_text.*: one run a point' one.gp || fail "a mean over one seed"
expect 0 "$clast" export dust.db --per run
same "$(python -c 'import csv; print([row["dust_fraction"] for row in csv.DictReader(open("out"))])')" "['', '']" "withheld in a file"
expect 64 "$clast" sensitivity dust.db -Q dust_fraction
says "no run has a value of dust_fraction: it is withheld in 2 of 2 runs (dust)"
# Facts of the computation have no mark; of a half-space the crater is told, whose shares of the mass are withheld.
expect 0 "$clast" simulate uniaxial --set 'fidelity.time_step=4 us' --set body.columns=6 --set body.rows=8 --all
grep -q '^energy_error .*[0-9] ! ' out && fail "a marked fact"
expect 0 "$clast" simulate solid-ice --set fidelity.projectile_spacing=0.5 --set fidelity.particles=1000 --set 'stop.end_time=2 us'
sed -n 2p out | grep -q '^crater.volume' || fail "a half-space does not open on its crater"

# A word without a row comes from another version of clast, and marks every result.
expect 0 "$clast" export marked.db old.db
python -c "
import sqlite3
db = sqlite3.connect('old.db')
db.execute(\"UPDATE run SET warnings = 'soot' WHERE point_id = 1\")
db.commit()"
expect 0 "$clast" stats old.db --by time_step
says "marked (!), 3 of 12 runs: soot: a word of another version of clast"

# An input that changes nothing is named by the runs themselves: friction bounds the tangential damping, which is off here.
cat >idle.yaml <<'YAML'
name: idle
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.least_time: 1 ms}
vary: {threshold.strain: [2 %, 5 %], contact.friction: [0.1, 0.5]}
seeds: {per_point: 2}
YAML
sed '/^set/s/}/, contact.tangential_damping: 1e4 1\/s}/' idle.yaml >acts.yaml # its sound twin
sed 's/per_point: 2/&, independent: true/' idle.yaml >alone.yaml  # no two runs differ in friction alone
for name in idle acts alone; do
  expect 0 "$clast" run $name.yaml --store $name.db -j 2
  cp err run.err
  expect 0 "$clast" stats $name.db --by threshold.strain
  same "$(cat err run.err | grep -o 'no effect in these runs: [a-z, ]*[a-z]' | sort -u)" \
    "$([ $name != idle ] || echo 'no effect in these runs: friction')" "inputs without effect of $name"
done
ok "inputs without effect"

# Messages send to `clast explain WORD`, also where an input or a result ends in the same word (under sanitizers every fifth).
expect 0 "$clast" explain conditions
for word in $(sed -n 's/^- \*\*\([a-z]*\)\*\* .*/\1/p' out | sort -u | awk -v s="$sanitized" 's == 0 || NR % 5 == 0'); do
  "$clast" explain "$word" >said || fail "explain $word"
  grep -q "^- \*\*$word\*\* " said || fail "explain $word does not tell the condition"
done
ok "every condition is explained"
# The functions that the help of query names are there.
expect 0 "$clast" query --help
named=$(sed '/^options:/q' out | grep -o '[a-z_][a-z_]*(' | sort -u | xargs)
same "$named" "doubts( median( stdev(" "functions in the help of query"
for function in $named; do
  expect 64 "$clast" query marked.db "select $function)"
  says "wrong number of arguments to function $function)"
done

# Results that runs lack by their nature, such as the first break of a body that did not break: their number is told, beside
# the mean and in a sentence, and more runs are needed for a width.
cat >lacks.yaml <<'YAML'
engine: command
name: lacks
command:
  program: awk
  version: "1"
  arguments: ["-f", "lacks.awk", "{{x}}", "{{small_seed}}"]
  files:
    lacks.awk: |
      function r() { s = (s * 16807) % 2147483647; return s / 2147483647 }
      BEGIN { s = ARGV[2] % 2147483647; r(); r(); a = r(); if (ARGV[1] > 0.5 || r() > 0.5) print "{\"a\": null}"; else printf "{\"a\": %.17g}\n", a }
  inputs:
    x: {default: 0, least: 0, most: 1, doc: x}
  results:
    a: {doc: a}
YAML
printf '%s\n' 'name: lack' 'scene: lacks.yaml' 'vary: {x: [0, 0.4, 1]}' 'seeds: 40' 'quantity: a' >lack.yaml
expect 0 "$clast" run lack.yaml --allow-commands --in-process -j 2 --quiet
values=$(number lack.db "select count(a) from runs where x = 0")
expect 0 "$clast" stats lack.db -Q a --by x
prints " ($values)"
says "a: $((120 - 2 * values)) of 120 runs have no value and are not in its numbers"
expect 0 "$clast" stats lack.db -Q mean_fragment_mass
! grep -q "have no value" err || fail "exponents tell themselves"
expect 0 "$clast" scatter lack.db -Q a --half-width 0.03 --point 1 --csv
python - "$values" <<'PY' || fail "runs needed"
import csv, math, sys
rows = {row[1]: row[2] for row in csv.reader(open("out"))}
value = lambda name: float(rows[name])
n = int(sys.argv[1])
assert value("runs") == n
sd = value("standard deviation")
assert 1 < value("runs needed") / (40 / n) / (1.96 * sd / 0.03) ** 2 < 1.1, (rows, sd)
assert value("runs needed, seeds.until") % 10 == 0 and value("runs needed, seeds.until") > value("runs needed"), rows
PY
ok "values that runs lack"

# A store has the word alone, not which of its two conditions the run breaks: both are told.
printf '%s\n' 'name: quiet' 'scene: disruption@draft' 'set: {fidelity.particles: 300, stop.quiet_time: 2 us}' \
  'seeds: {per_point: 1}' >quiet.yaml
expect 0 "$clast" run quiet.yaml --quiet
expect 0 "$clast" stats quiet.db
says "crosses the target is below 1, or stop.quiet_growth is above 0.01 (clast explain quiet)"
# A word of two conditions withholds some results and marks others.
expect 0 "$clast" explain ejecta.mass_fraction
tr '\n' ' ' <out | grep -q 'box' && ! grep -qF '(box)' out || fail "box is said to withhold a mass share"
expect 0 "$clast" explain undamaged_fraction
grep -qF '(box)' out || fail "box withholds the undamaged mass"
# A name with a space is that file.
"$clast" scenes disruption >"my scene.yaml"
sed 's/^name: .*/name: another/' "my scene.yaml" >my_scene.yaml
expect 0 "$clast" explain "my scene.yaml"
grep -q '^disruption' out || fail "explains another file"
printf 'name: odd\nscene: my scene.yaml\n' >odd.yaml
expect 65 "$clast" explain odd.yaml
tr '\n' ' ' <err | grep -qF "\`clast explain 'my scene.yaml'\` explains the scene" || fail "advice without quotes"
done_after 137
