# Runs that a person excludes (clast exclude): every question leaves them out and says so, nothing computes or replaces them, the
# reason travels with merge and export, an older store takes them, and --undo gives back the same answers, byte for byte.
. "$(dirname "$0")/lib.bash"

tiny one
sed -i 's/per_point: 3/per_point: 5/' one.yaml
expect 0 "$clast" run one.yaml -j 2 --quiet
cat >line.yaml <<'YAML'
name: line
scene: disc-explosion
set: {body.diameter: 6 cm, charge.energy: 2 kJ/m, stop.end_time: 0.3 ms}
vary: {threshold.strain: {uniform: [1 %, 6 %]}, threshold.angle: {uniform: [2 deg, 6 deg]}}
design: {kind: sobol, points: 4}
seeds: {per_point: 2}
YAML
"$clast" sensitivity line.yaml ask.yaml --design saltelli --blocks 4 >out 2>err || fail "no design"
expect 0 "$clast" run ask.yaml --store ask.db -j 2 --quiet
printf '# source: made up\nmass (kg), count\n0.05, 3\n0.2, 1\n' >measured.csv

# Every question to a store, as programs see it. Pictures are compared by the data that gnuplot draws.
questions=(
  "stats one.db --by strain,angle --quantity main"
  "stats one.db"
  "estimates one.db"
  "scatter one.db"
  "scatter one.db --by strain"
  "exponents one.db --draws 100"
  "spectrum one.db"
  "spectrum one.db --with measured.csv"
  "compare one.db:1 one.db:2"
  "sensitivity ask.db ask.yaml"
)
answers() { # answers FOLDER: the answers of all questions, and what they say, in files
  local i
  mkdir -p "$1"
  for i in "${!questions[@]}"; do
    # shellcheck disable=SC2086
    "$clast" ${questions[$i]} --csv >"$1/$i.csv" 2>"$1/$i.said" || fail "${questions[$i]}: $(cat "$1/$i.said")"
  done
  "$clast" plot one.db "$1/plot.svg" -x strain --by angle --keep-script 2>"$1/plot.said" || fail "plot"
  "$clast" map one.db "$1/map.svg" -x strain -y angle --keep-script 2>"$1/map.said" || fail "map"
  "$clast" spectrum one.db --picture "$1/spectrum.svg" --keep-script >/dev/null 2>"$1/spectrum.said" || fail "spectrum"
  "$clast" extremes one.db --csv >"$1/extremes.csv" 2>"$1/extremes.said" || fail "extremes"
  "$clast" report one.db -o "$1/page.html" 2>"$1/page.said" || fail "report"
  rm "$1/page.html"
}
answers before
# The first run of point 1 and of the sensitivity design's first point are bad.
expect 64 "$clast" exclude one.db 1
says "--reason"
expect 64 "$clast" exclude one.db 1 --reason ""
expect 64 "$clast" exclude one.db 999 --reason "none"
says "there is no run 999"
expect 64 "$clast" exclude one.db 1 --undo
says "run 1 is not excluded"
expect 64 "$clast" exclude one.db --undo
says "\`clast exclude one.db\` lists those that are excluded, by run_id"
expect 64 "$clast" exclude one.db --reason "none"
says "The query of \`clast exclude --help\` on one.db lists them by run_id"
expect 0 "$clast" exclude one.db
silent out
says "no run is excluded"
run=$("$clast" query one.db "select run_id from runs order by run_id limit 1" --csv | tail -1) # its lines end with LF
expect 0 "$clast" exclude one.db "$run" --reason "the camera saw a flaw"
says "1 run is excluded"
expect 0 "$clast" exclude one.db
prints "the camera saw a flaw"
expect 0 "$clast" exclude one.db --csv
prints "run_id,point_id,seed,date,reason"
expect 0 "$clast" exclude ask.db 1 --reason "bad"
answers after
cat >ball.yaml <<'YAML'
name: ball
scene: disc-explosion
set: {body.diameter: 6 cm, charge.energy: 2 kJ/m, stop.end_time: 0.3 ms}
vary: {threshold.strain: {uniform: [1 %, 6 %]}}
design: {kind: sobol, points: 8}
seeds: 2
store: both.db
YAML
printf 'name: shot\nsource: made up\nshots: [{measured: [{quantity: largest_fraction, value: 0.3, error: 0.05}]}]\n' >shot.yaml
cp one.db both.db
expect 0 "$clast" fit shot.yaml ball.yaml --rounds 3 -j 2 --quiet --store both.db
mv err after/fit.said
"$clast" converge one.yaml --knob integrator --seeds 2 --within off -j 2 --quiet --store both.db >out 2>after/converge.said || fail "converge"
for said in after/*.said; do
  grep -q '1 run is excluded and left out (`clast exclude [a-z]*.db` lists it)' "$said" || fail "$said does not say it: $(cat "$said")"
  ok "$said says it"
done
for operand in one.db:1 one.db:one; do # the command that is told takes the store alone
  expect 0 "$clast" report "$operand" -o page.html
  says "\`clast exclude one.db\` lists it"
  expect 0 "$clast" compare "$operand" "$operand"
  says "\`clast exclude one.db\` lists it"
  rm page.html
done
for before in before/*.csv before/*.dat; do
  cmp -s "$before" "after/$(basename "$before")" && fail "$before: the answer holds the excluded run"
  ok "$before: another answer without the run"
done
captions=$(sed "s/'\.\"\\\\n\"\.'/ /g" after/*.gp | grep -c "^caption_text = .*; 1 run excluded;") # on two lines or one
same "$captions" 3 "captions that say it"
same "$(number one.db 'select n || "/" || excluded from points where point_id = 1')" "4/1" "runs and excluded runs of the point"
same "$("$clast" stats one.db --by strain,angle --json 2>/dev/null | grep -o '"excluded": 1' | wc -l)" 1 "groups with an excluded run"
expect 0 "$clast" stats one.db --by strain,angle
prints "excluded"
expect 0 "$clast" status one.db
prints "excluded"
says "1 run is excluded"
expect 0 "$clast" check one.db
expect 0 "$clast" check ask.db

# Nothing computes it again: not the campaign, not more seeds, not a rule, not a retry, not a replay.
expect 0 "$clast" run one.yaml -j 2
same "$(number one.db 'select count(*) from run')" 20 "runs after the same campaign"
same "$(number one.db 'select counts || excluded from run where run_id = 1')" "0the camera saw a flaw" "the run"
expect 0 "$clast" run one.yaml --seeds 6 -j 2 --quiet
same "$(number one.db 'select n || "/" || excluded from points where point_id = 1')" "5/1" "of six seeds"
same "$(number one.db 'select count(*) from run where point_id = 1')" 6 "runs of the point"
expect 0 "$clast" retry one.db
says "no run was given up"
expect 0 "$clast" replay one.db 1
# A rule takes it for a run without a value.
sed "s/seeds: .*/seeds: {until: {quantity: largest_fraction, half_width: 0.2}, max: 60}/" one.yaml >until.yaml
"$clast" run until.yaml --store until.db -j 2 --quiet >out 2>err || fail "the rule"
"$clast" exclude until.db 1 --reason "bad" 2>err || fail "exclude"
expect 0 "$clast" run until.yaml --store until.db -j 2 --quiet
same "$(number until.db 'select counts from run where run_id = 1')" 0 "after the rule"
expect 0 "$clast" check until.db

# One choice of runs for all questions: each command of the results that reads a store has it.
without="query picture" # SQL of one's own; files
for command in $("$clast" help | sed -n '/^results:/,/^the store:/s/^  \([a-z]*\) .*/\1/p'); do
  case " $without " in *" $command "*) continue ;; esac
  "$clast" "$command" --help >out
  grep -q -- "--campaign CAMPAIGN" out && grep -q -- "--where SQL" out && grep -q -- "--point N" out ||
    fail "clast $command cannot choose runs"
done
ok "every question chooses runs"
# A ready query, too.
two_scenes queried.db
expect 0 "$clast" query queried.db --named points --campaign crash --csv
same "$(tail -n +2 out | cut -d, -f1 | tr '\n' ' ')" "$("$clast" query queried.db "select point_id from campaign_point join campaign using (campaign_id) where name = 'crash'" --csv | tail -n +2 | tr '\n' ' ')" "points of one campaign"
expect 64 "$clast" query queried.db --named slowest --where "seed < 0"
same "$("$clast" stats one.db --by strain --where 'replicate < 2' --csv 2>/dev/null | cut -d, -f4,5 | tail -n 1)" "2,4" "points and runs"
same "$("$clast" estimates one.db --where 'replicate = 1' --csv 2>/dev/null | grep -c ',from_2,')" 4 "points with the second seed"
same "$("$clast" estimates one.db --campaign one --point 2 --csv 2>/dev/null | wc -l)" 4 "rows of a point"
# A campaign's points count with all their runs: what another campaign computed there is told.
for part in 1 2; do
  sed "s/^name: .*/name: b$part/; s/^seeds: .*/seeds: {per_point: 3, first: $part}/; s/^store: .*/store: b$part.db/" one.yaml >b$part.yaml
  "$clast" run b$part.yaml -j 2 --quiet >out 2>err || fail "b$part"
done
expect 0 "$clast" stats b1.db --campaign b1
grep -q "whoever computed" err && fail "a campaign alone has runs of others"
"$clast" merge b1.db b2.db >out 2>err || fail "merge of b1 and b2"
expect 0 "$clast" stats b1.db --campaign b1
says "clast: campaign b1: runs at its points count, whoever computed them; other campaigns computed 4 of them"
expect 64 "$clast" map one.db no.svg -x strain -y angle --campaign two
says "the store has no campaign 'two'"
expect 64 "$clast" stats one.db --where "no_such > 1"
says "no such column: no_such"
same "$("$clast" stats one.db --where "strain > 0.02" --csv 2>/dev/null)" \
  "$("$clast" stats one.db --where "threshold_strain > 0.02" --csv 2>/dev/null)" "a short name"
# A result that has the name of a varied input, up to rounding: the input, as in the tables.
printf '%s\n' 'name: shot' 'scene: disruption' 'set: {fidelity.particles: 400, fidelity.projectile_spacing: 0.3}' \
  'vary: {impact.specific_energy: [1.1 kJ/kg, 2.3 kJ/kg, 3.7 kJ/kg]}' 'seeds: {per_point: 2}' 'store: shot.db' >shot.yaml
expect 0 "$clast" run shot.yaml -j 2 --quiet # with warnings of few particles
same "$("$clast" query shot.db --where "specific_energy in (1100, 2300, 3700)" "select count(*) from runs" --csv 2>/dev/null | tail -n 1)" 6 "runs by their input"
expect 64 "$clast" stats one.db --where "threshold.strain > 0.02"
says "The view runs has threshold_strain"
expect 64 "$clast" stats one.db --where "strain = 5%"
says "SQL error: incomplete input"; grep -q chosen_point err && fail "SQL of the program"
for command in "compare one.db" stats estimates status extremes spectrum; do # no empty table, and no other reason
  expect 64 "$clast" $command one.db --where "seed < 0"
  says "one.db: none of the runs meets --where \"seed < 0\""
done
expect 64 "$clast" query one.db "select threshold.strain from runs"
says "The view runs has threshold_strain"
expect 64 "$clast" stats one.db --where "1) ; DELETE FROM run --"
expect 0 "$clast" plot one.db chosen.svg -x strain --where "replicate < 2" --keep-script
grep -qF "only replicate < 2" <(sed 's/.\."\\n"\../ /g' chosen.gp) || fail "the caption does not tell the choice"
expect 0 "$clast" compare one.db one.db --where "threshold_strain < 0.03" --csv
same "$(wc -l <out)" 3 "pairs of points"

# It travels with the run: an export has it, and so has a merge that adds the run. A store that has the run keeps its own word.
expect 0 "$clast" export one.db copy.db
same "$(number copy.db 'select excluded from run where run_id = 1')" "the camera saw a flaw" "in the copy"
expect 0 "$clast" merge all.db one.db
same "$(number all.db 'select count(*) from runs where excluded is not null')" 1 "in the merged store"
expect 0 "$clast" check all.db
"$clast" exclude one.db 1 --undo 2>err || fail "undo"
expect 0 "$clast" merge all.db one.db
says "1 run of one.db stays excluded in all.db"
"$clast" exclude one.db 1 --reason "the camera saw a flaw" 2>err || fail "exclude"
expect 0 "$clast" exclude all.db 1 --undo
expect 0 "$clast" merge all.db one.db
same "$(number all.db 'select count(*) from runs where excluded is not null')" 0 "the store's own word"
says "one.db excludes 1 run that counts in all.db"

# A store without the columns is read, and gets them when it is written.
expect 0 "$clast" run one.yaml --store old.db -j 2 --quiet
python - <<'PY'
import sqlite3
db = sqlite3.connect("old.db")
for view in "runs", "points", "spectra", "estimates", "resolution":
    db.execute(f"DROP VIEW {view}")
db.executescript("ALTER TABLE run DROP COLUMN excluded; ALTER TABLE run DROP COLUMN excluded_at;")
PY
expect 0 "$clast" stats old.db
expect 0 "$clast" exclude old.db
says "no run is excluded"
expect 0 "$clast" exclude old.db 2 3 --reason "two of them"
expect 0 "$clast" exclude old.db
same "$(grep -c 'two of them' out)" 2 "runs of an older store"

# Taken back, the answers are the same bytes.
expect 0 "$clast" run one.yaml --store fresh.db -j 2 --quiet
cp fresh.db one.db
"$clast" exclude ask.db 1 --undo 2>err || fail "undo"
answers again
"$clast" exclude ask.db 1 --reason "bad" 2>err || fail "exclude"
expect 0 "$clast" exclude one.db 1 7 --reason "a mistake"
expect 0 "$clast" exclude one.db 1 7 --undo
"$clast" exclude ask.db 1 --undo 2>err || fail "undo"
answers undone
rm again/page.said # it names its file
for file in again/*.csv again/*.dat again/*.svg again/*.said; do
  cmp "$file" "undone/$(basename "$file")" || fail "$file differs after --undo"
done
ok "the same answers after --undo"
expect 0 "$clast" check one.db

# Settings of one store that differ, although no campaign varies them, are inputs of its tables.
tiny settings
sed -i 's/settings.db/fresh.db/; s/name: settings/name: one/; s/seeds: .*/seeds: 2/; s/stop.end_time: 1 ms/stop.end_time: 0.9 ms/' settings.yaml
expect 0 "$clast" run settings.yaml -j 2 --quiet
says "stop.end_time (0.001 s there, 0.0009 s here) differs, and is a varied input of this store from now on"
expect 0 "$clast" stats fresh.db --by end_time --csv
same "$(cut -d, -f1 out | tail -n +2 | tr '\n' ' ')" "0.0009 0.001 " "settings"
expect 0 "$clast" check fresh.db
done_after 121
