#!/usr/bin/env bash
# The command line itself: help, version, completion, mistakes, a reader that goes away, a full disk.
. "$(dirname "$0")/lib.bash"

expect 0 "$clast" help
silent err
commands=$(sed -nE 's/^  ([a-z]+)  +[A-Za-z].*/\1/p' out)
same "$(echo $commands --help --version)" "$(echo $("$clast" completion bash -- ""))" "commands in help and completion"
for command in $commands; do
  "$clast" "$command" --help >out 2>err || fail "$command --help"
  silent err
  for part in usage: options: examples: "exit codes:" "clast $command"; do prints "$part"; done
  "$clast" help "$command" | cmp -s - out || fail "help $command differs from $command --help"
  options=$("$clast" completion bash -- "$command" --)
  for option in $options; do prints "$option"; done
  [ "$(grep -cE '^  (-.,|   ) --' out)" -eq "$(echo "$options" | wc -l)" ] || fail "options of $command in help and completion"
done
ok "help of every command is whole: $(echo $commands)"

expect 64 "$clast"
says "which command"
expect 64 "$clast" simualte
says "did you mean \`clast simulate\`?"
one_error
silent out
expect 64 "$clast" elephant
says "no command \"elephant\""
expect 64 "$clast" --frobnicate
expect 64 "$clast" explain --stt a=b
says "did you mean --set?"
one_error
expect 64 "$clast" explain a b
says "does not know what to do with \"b\""
expect 64 "$clast" scenes --json --csv
says "exclude each other"
expect 64 env CLAST_CPU=v9 "$clast" scenes # a class misspelt would be another class's bits
says "baseline, v3 or v4"
expect 0 env CLAST_CPU=v3 "$clast" scenes
expect 64 "$clast" query
expect 64 "$clast" completion tcsh
expect 64 "$clast" simulate
expect 64 "$clast" simulate disc-explosion --seed -1
expect 64 "$clast" simulate disc-explosion --seed 1e3
expect 64 "$clast" simulate disc-explosion --set threshold.strain
says "PATH=VALUE"
expect 64 "$clast" simulate disc-explosion --set nosuch=1
says "nosuch"; one_error
expect 64 "$clast" run x.yaml -j many
expect 64 "$clast" run x.yaml -j

# what a newcomer types first
expect 64 "$clast" simulate disc-explosion --set threshold.angle='60000 deg'
says "at most 57295.8 deg"
same "$("$clast" explain 2>/dev/null | awk '$3 == "threshold.angle" { print $4, $5, $6 }')" "deg 4 deg" "an angle for people"
[[ "$("$clast" explain weibull.k | tr -s ' \n' ' ')" == *"real in m^-3, at least 1 and at most 1e200 m^-3"* ]] || fail "a unit as people write it"
for word in weibull damage M_1/M ks knob seed projectile weibull.k; do expect 0 "$clast" explain "$word"; done
prints "target.material.weibull.k"; prints "projectile.material.weibull.k: the same"
expect 0 "$clast" explain basalt-sphere --set radius='2 cm' --set weibull.m=9 # of two bodies the one that cracks
grep -qE '^target.radius +0.02 m' out && grep -qE '^target.material.weibull.m +9 ' out || fail "paths that two bodies have"
grep -qE '^impact.angle +30 deg' out || fail "an angle is not in degrees"
printf 'engine: sph\nkind: impact\ntarget: {shape: box, side: 3 cm}\n' >side.yaml
expect 65 "$clast" explain side.yaml
says "width, depth, height"
printf 'name: four\nscene: disc-explosion\nseeds: 4\n' >four.yaml
expect 0 "$clast" plan four.yaml --no-trial
grep -qE '^runs +4,' out || fail "seeds: 4"
expect 0 "$clast" plan four.yaml --no-trial --seeds 7
grep -qE '^runs +7,' out || fail "seeds: 4 and --seeds 7"
# one letter is one option
for command in $commands; do "$clast" "$command" --help | sed -nE 's/^  -(.), --([a-z-]+).*/\1 \2/p'; done | sort -u >letters
[ -z "$(cut -d' ' -f1 letters | uniq -d)" ] || fail "a letter with two meanings: $(cut -d' ' -f1 letters | uniq -d)"
ok "a letter is one option"

expect 0 "$clast" --version
prints "clast $(sed -nE 's/^project\(clast VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")"
for fact in commit compiler flags MPI SQLite HDF5 GSL libfyaml cpu_class; do prints "$fact"; done
expect 0 "$clast" --version --json
python -c "import json; d = json.load(open('out')); assert d['version'] and d['commit'] and d['compiler'], d"
ok "--version --json is JSON"
expect 0 "$clast" version --json

# bash accepts the completion, and it completes; it calls clast by its name
"$clast" completion bash >completion.bash
export PATH=${clast%/*}:$PATH
bash -c '. ./completion.bash; COMP_WORDS=(clast stat); COMP_CWORD=1; _clast; echo "${COMPREPLY[*]}"' >out
prints "status stats"
bash -c '. ./completion.bash; COMP_WORDS=(clast run --dry); COMP_CWORD=2; _clast; echo "${COMPREPLY[*]}"' >out
prints "--dry-run"
bash -c '. ./completion.bash; COMP_WORDS=(clast run a.yaml --set contact.fri); COMP_CWORD=4; _clast; echo "${COMPREPLY[*]}"' >out
prints "contact.friction="
bash -c '. ./completion.bash; COMP_WORDS=(clast explain target.material.wei); COMP_CWORD=2; _clast; echo "${COMPREPLY[*]}"' >out
prints "target.material.weibull.m target.material.weibull.k"
bash -c '. ./completion.bash; COMP_WORDS=(clast run --store ""); COMP_CWORD=3; _clast; echo "<${COMPREPLY[*]}>"' >out
prints "<>" # names of files, by bash
ok "bash completion completes"

# stdout: a reader that goes away is no error, a full disk is 74
{ sleep 1; got=0; "$clast" explain 2>err || got=$?; echo "$got" >code; } | true
same "$(cat code)" 0 "exit code when nobody reads stdout"
silent err
expect 74 bash -c "'$clast' explain >/dev/full"
says "standard output"
one_error
expect 74 bash -c "'$clast' explain --json >/dev/full"
expect 74 bash -c "'$clast' help >/dev/full"
for words in help "explain disc-explosion" "scenes --json"; do
  expect 74 bash -c "'$clast' $words >&-"
  says "standard output"
done
expect 0 bash -c "'$clast' help <&- 2>&-"

# one input under two names
for words in "simulate disc-explosion" "explain disc-explosion" "converge disc-explosion --knob grains=2cm,1cm"; do
  expect 64 bash -c "'$clast' $words --set contact.friction=0.1 --set friction=0.2"
  says "--set friction: the same input as --set contact.friction"
done
for words in "simulate disc-explosion" "explain disc-explosion" "plan any.yaml"; do
  expect 64 bash -c "'$clast' $words --set friction=0.1 --set friction=0.2"
  says "--set is given twice, as \"friction=0.1\" and \"friction=0.2\""
done
# a scene: what, cost and doubts come before its inputs, and what is modelled after them
for scene in disc-explosion basalt-sphere; do
  expect 0 "$clast" explain $scene
  same "$(grep -oE ' of a core|^in doubt|^input|^  modelled|^  beams:' out | xargs)" \
    "of a core in doubt input $([ $scene = basalt-sphere ] && echo modelled || echo beams:)" "order of an explanation"
done
# a wrong name in a section: what is in it
expect 64 "$clast" simulate basalt-sphere --set target.shape=box --set target.side='3 cm'
says "no 'target.side'; known in 'target' are shape, "; says "width, depth, height"

# an option that lets foreign programs run is written out: neither --all nor --allow is a short form of it
expect 64 "$clast" serve any.yaml --all
says "has no option --all"
expect 64 "$clast" plan any.yaml --allow
says "has no option --allow"

# a device that never ends is no input
for words in "converge /dev/zero" "plan /dev/zero" "materials /dev/zero" "simulate /dev/zero"; do
  expect 65 bash -c "ulimit -t 10; [ $sanitized -ne 0 ] || ulimit -v 20000000; exec '$clast' $words" # a sanitizer maps terabytes
done
done_after 66
