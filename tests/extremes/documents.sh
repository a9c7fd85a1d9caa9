#!/usr/bin/env bash
# Campaign and scene files that are empty, missing, binary, huge, truncated, adversarial or just wrong: one clear report,
# the documented exit code, no store made.
. "$(dirname "$0")/../cli/lib.bash"

run() { expect "$1" "$clast" run "$2" --quiet; silent out; [ -s err ] || fail "no message"; [ ! -e x.db ] || fail "a store was made"; }
campaign() { printf '%b\n' "$2" >"$1"; }

run 66 missing.yaml; says "missing.yaml"
mkdir folder.yaml; run 74 folder.yaml
: >empty.yaml; run 65 empty.yaml
run 65 /dev/null
head -c 20000 /dev/urandom >binary.yaml; run 65 binary.yaml
campaign nul.yaml 'name: x\nscene: disc-expl\0osion'; run 65 nul.yaml
campaign utf8.yaml 'name: x\nscene: disc-explosion\nstore: x.db # \xff\xfe'; run 65 utf8.yaml
campaign second.yaml 'name: x\nscene: disc-explosion\n---\nname: y'; run 65 second.yaml
campaign list.yaml '- a\n- b'; run 65 list.yaml
campaign scalar.yaml 'just words'; run 65 scalar.yaml
campaign tab.yaml 'name: x\nset:\n\tgrain.density: 3'; run 65 tab.yaml; says "tab.yaml:3"
campaign open.yaml 'name: x\nset: {grain.density: 3'; run 65 open.yaml
campaign bomb.yaml 'a: &a [x,x,x,x,x,x,x,x,x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b]\nd: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c]\ne: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: &f [*e,*e,*e,*e,*e,*e,*e,*e,*e]\ng: [*f,*f,*f,*f,*f,*f,*f,*f,*f]'
run 65 bomb.yaml
campaign cycle.yaml 'name: &a [*a]\nscene: disc-explosion'; run 65 cycle.yaml
{ printf 'name: '; head -c 100000 /dev/zero | tr '\0' '['; } >deep.yaml; run 65 deep.yaml
{ echo 'name: x'; head -c 6000000 /dev/zero | tr '\0' '#'; } >huge.yaml; run 65 huge.yaml
head -c 70000 /dev/zero | tr '\0' 'k' >longkey.yaml; run 65 longkey.yaml
[ "$(wc -c <err)" -lt 8000 ] || fail "the report repeats the whole file"

# Mistakes that people make: all of a file in one report, each with its place and remedy
cat >wrong.yaml <<'YAML'
name: wrong
scene: disc-explosion
sede: 3
set: {threshold.strian: 2 %, grain.density: 5 km/s, contact.friction: .nan}
vary:
  threshold.angle: [2 deg, 4 m]
  threshold.strain: [2 %, -1 %]
seeds: {per_point: 0}
store: x.db
YAML
run 65 wrong.yaml
for line in 3 4 6 7 8; do says "wrong.yaml:$line:"; done
says "seeds"; says "threshold.strain"; says "^"
[ "$(grep -c 'error: ' err)" -ge 6 ] || fail "not all errors in one report"
campaign twice.yaml 'name: x\nname: y\nscene: disc-explosion'; run 65 twice.yaml
campaign scene.yaml 'name: x\nscene: disc-explosoin\nstore: x.db'; run 65 scene.yaml; says "disc-explosion"
campaign scenefile.yaml 'name: x\nscene: none/such.yaml\nstore: x.db'
run 65 scenefile.yaml; says "scenefile.yaml:2:"; says "none/such.yaml"
campaign number.yaml 'name: x\nscene: disc-explosion\nvary: {threshold.strain: [1e999 %]}\nstore: x.db'; run 65 number.yaml
campaign million.yaml 'name: x\nscene: disc-explosion\nvary: {threshold.strain: {from: 1 %, to: 5 %, n: 100000000000000000000}}\nstore: x.db'
run 65 million.yaml
campaign inactive.yaml 'name: x\nscene: disc-explosion\nset: {impact.speed: 3 m/s}\nstore: x.db'; run 65 inactive.yaml; says "impact.speed"
campaign unnamed.yaml 'name: x\nscene: ""\nstore: x.db'; run 65 unnamed.yaml; says "empty"

# The same files as scenes
for file in empty binary nul second list bomb deep huge; do
  expect 65 "$clast" explain "./$file.yaml"
  silent out
done
expect 66 "$clast" explain ./missing.yaml
expect 66 "$clast" simulate ./missing.yaml
expect 64 "$clast" simulate disc-explosion --set threshold.strain=inf
expect 64 "$clast" simulate disc-explosion --set threshold.strain='3 kg'
says "kg"
expect 64 "$clast" simulate disc-explosion --set treshold.strain=3%
says "threshold.strain"
expect 65 "$clast" simulate disc-explosion --set impact.speed=3m/s
says "impact.speed"

# A bare number where a unit belongs: 4 would be 229 degrees, 5 would be 500 %. In documents and on the command line, alone and in
# every form of an axis. 0 is 0 in any unit.
expect 64 "$clast" simulate disc-explosion --set threshold.angle=4
says "write '4 deg' or '4 rad'"
expect 64 "$clast" simulate disc-explosion --set threshold.strain=5
says "write '5 %' or '500 %'"
for form in '[2]' '[2 deg, 3]' '{from: 1, to: 7 deg, n: 3}' '{log: [1 deg, 7], n: 3}' '{uniform: [1, 7 deg]}' \
  '{normal: {mean: 4, sd: 1 deg}}' '{normal: {mean: 4 deg, sd: 1}}' '{lognormal: {median: 4, sigma: 0.1}}'; do
  campaign bare.yaml "name: x\nscene: disc-explosion\nvary: {threshold.angle: $form}\nstore: x.db"
  run 65 bare.yaml; says "bare.yaml:3:"; says "has no unit; write"
done
campaign bare.yaml 'name: x\nscene: disc-explosion\nset: {threshold.strain: 0.03}\nlimits: {time: 60}\nstore: x.db'; run 65 bare.yaml
says "bare.yaml:3:"; says "write '0.03 %' or '3 %'"; says "bare.yaml:4:"; says "write '60 us' or '60 s'"
printf 'engine: dem\nthreshold: {angle: 4}\n' >bare_scene.yaml
expect 65 "$clast" explain ./bare_scene.yaml
says "bare_scene.yaml:2:20"
campaign zero.yaml 'name: x\nscene: disc-explosion\nset: {contact.normal_damping: 0, stop.least_time: 0}\nstore: x.db'
expect 0 "$clast" plan zero.yaml --no-trial
done_after 52
