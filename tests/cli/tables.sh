#!/usr/bin/env bash
# Every table that a person reads: at most 100 characters wide, with the varied inputs, also with --all; programs get all.
. "$(dirname "$0")/lib.bash"
unset COLUMNS
toy=$(dirname "$clast")/tests/clast_toy
cat >stick.yaml <<'YAML'
engine: toy
name: stick
YAML
cat >toy.yaml <<'YAML'
name: a-campaign-with-a-name-that-is-rather-long
scene: ./stick.yaml
vary: {stick.strain: [3 %, 5 %], stick.angle: [4 deg, 8 deg]}
seeds: {per_point: 20}
store: toy.db
YAML
expect 0 "$toy" run toy.yaml -j 1

widest() { python -c "print(max([len(l.rstrip('\n')) for l in open('out', encoding='utf-8')], default=0))"; }
# table PROGRAM ARGUMENTS...: at most 100 wide, with --all too; to a terminal of 60 or 140 columns, as wide as that
table() {
  expect 0 "$@"
  [ "$(widest)" -le 100 ] || fail "$(widest) characters wide: $*"
  expect 0 "$@" --all
  [ "$(widest)" -le 100 ] || fail "$(widest) characters wide: $* --all"
}
for command in "stats toy.db --by strain,angle" "stats toy.db --by strain,angle -Q main" "estimates toy.db" "exponents toy.db" \
  "scatter toy.db" "scatter toy.db --by angle,strain" "spectrum toy.db" "status toy.db" \
  "spectrum toy.db --cumulative --by strain" "extremes toy.db" "compare toy.db:1 toy.db:3" "compare toy.db toy.db" \
  "simulate stick.yaml" "explain stick.yaml"; do
  table "$toy" $command
done
for command in scenes materials explain "query --list" "cite basalt-sphere" "explain basalt-sphere" "explain disc-explosion" \
  "converge --list" "explain conditions" "explain results" "explain campaign" "explain sph"; do
  table "$clast" $command
done
for view in runs points spectra estimates; do
  table "$toy" query toy.db "select * from $view"
  for name in stick_ angle strain; do sed '/^ *1 /q' out | grep -q $name || fail "the table of $view lacks $name"; done
done
for name in points scatter progress censored failures cost slowest provenance axes columns run-exponents exponents; do
  table "$toy" query toy.db -n $name
done
ok "tables are at most 100 characters wide"

# varied inputs first, by short names and in the units of the campaign; a value with its error; the rest by name
expect 0 "$toy" stats toy.db --by strain,angle
prints "strain [%]  angle [deg]"
[ "$(grep -cE '^ +(3|5) +(4|8) .*0\.[0-9]+ ± 0\.[0-9]+' out)" -eq 4 ] || fail "no value with its error"
says "not shown (--all)"; says "engine toy"
expect 0 env COLUMNS=60 "$toy" stats toy.db --by strain,angle -Q main
[ "$(widest)" -le 60 ] || fail "wider than COLUMNS"
prints strain; prints angle
for word in largest_ second_ mean_ dust_ fragment_; do prints $word; done # asked for, so never left out
expect 0 "$toy" stats toy.db --by strain,angle --csv
prints "stick_strain,stick_angle,engine,results_version,points,n,failed,censored,excluded,largest_fraction_mean,largest_fraction_sd"
# masses of a scene in the plane are per metre of thickness
expect 0 "$clast" simulate disc-explosion --set body.diameter='6 cm' --set stop.end_time='0.1 ms' --all
grep -qE '^mean_fragment_mass .* kg/m ' out || fail "a mass of a scene in the plane in kg"
done_after 90
