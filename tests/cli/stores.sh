#!/usr/bin/env bash
# Stores under other names and in unusual places, texts from strangers, and tables that must show what differs: the answer is
# right, or the message names the cause.
. "$(dirname "$0")/lib.bash"

# A name that a spreadsheet would run, and one that would steer the terminal.
one() { # one NAME [LINE]: a campaign of one short run
  printf 'name: "%s"\nscene: disc-explosion\nset: {body.diameter: 8 cm, stop.end_time: 0.05 ms}\nseeds: {per_point: %s}\nstore: %s.db\n%s\n' \
    "${3:-$1}" "${4:-1}" "$1" "${2:-}" >"$1.yaml"
}
# Two scenes in one store: a mean over both says so.
one discs
one collision
sed -i 's/disc-explosion/disc-collision/; s/store: .*/store: discs.db/' collision.yaml
expect 0 "$clast" run discs.yaml -j 1 --quiet
expect 0 "$clast" run collision.yaml -j 1 --quiet
expect 0 "$clast" stats discs.db
says "pooled over scene, "

one formula '' '=HYPERLINK(1)'
expect 0 "$clast" run formula.yaml -j 1 --quiet
expect 0 "$clast" status formula.db --csv
prints ",'=HYPERLINK(1),"
expect 0 "$clast" query formula.db "select char(27) || ']0;x' || char(7) as x" --csv
same "$(tr -cd '\033\007' <out | wc -c)" 0 "control characters in CSV"

# Every varied input is in the table of a sweep, by a short name; what is left out is named.
cat >two.yaml <<'YAML'
name: two
scene: basalt-sphere
set: {particles: 200, stop.end_time: 5 us}
vary: {target.material.weibull.m: [8, 9], target.material.weibull.k: [1e34 1/m^3, 5e34 1/m^3]}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run two.yaml -j 1 --quiet
same "$(head -1 out | sed -E "s/^ *m +k \[m\^-3\] +point .*/m k/")" "m k" "varied inputs of the table, in the order of the campaign"
same "$(sed 1d out | grep -cE '^ *(8|9) +(5×)?10\^34 ')" 4 "rows of four points"
[ "$(LC_ALL=C.UTF-8 wc -L <out)" -le 100 ] || fail "wider than 100 columns"
one many 'vary: {threshold.strain: [2 %], threshold.angle: [2 deg], contact.friction: [0.1], charge.energy: [2000 J/m], threshold.modulus: [10], contact.bonded: [true], stop.least_time: [0.02 ms]}'
sed -i 's/threshold.modulus: \[10\], //' many.yaml
expect 0 "$clast" run many.yaml -j 1
says "not shown (--all): "; says "beta LSQ"
for word in strain angle friction energy bonded time; do sed '/^ *[0-9]/q' out | grep -q "$word" || fail "the table lacks $word"; done

# A study or a search in the store of a campaign changes no table of it: what only the study varied is no input of its
# points. Neither is what follows from a material.
one charged 'vary: {charge.energy: [500 J/m, 2000 J/m]}' '' 2
study=(-Q largest_fraction --within off --seeds 2 --max-seeds 2 -j 2)
expect 0 "$clast" run charged.yaml -j 2
for of in estimates scatter spectrum exponents; do "$clast" $of charged.db >charged-$of 2>/dev/null; done
expect 0 "$clast" converge charged.yaml --knob time_step,integrator,stop --knob grains=1.2cm,1.069cm "${study[@]}" -q
for of in estimates scatter spectrum exponents; do
  expect 0 "$clast" $of charged.db
  same "$(head -1 out | tr -s ' ')" "$(head -1 charged-$of | tr -s ' ')" "columns of $of"
done
expect 0 "$clast" query charged.db "select count(*) from runs where not study" --csv
same "$(tail -1 out)" 4 "runs without those of the study"
expect 0 "$clast" query charged.db "select count(*) from runs" --csv
says "of this store are at points that only studies and searches have"
expect 0 "$clast" export charged.db --per run
same "$(sed 1d out | wc -l)" 4 "rows of runs"
expect 0 "$clast" export charged.db --per run --studies
[ "$(sed 1d out | wc -l)" -gt 4 ] || fail "the study's runs are left out"
# The points of a study are its points, too, where it is chosen alone.
expect 0 "$clast" export charged.db --per run --campaign 'charged grains' --where study
[ "$(sed 1d out | wc -l)" -gt 1 ] || fail "a chosen study has no points"
expect 64 "$clast" export charged.db whole.db --campaign 1
expect 0 "$clast" run charged.yaml
same "$(head -1 out | tr -s ' ')" "$(head -1 charged-estimates | tr -s ' ')" "columns of run"
for format in csv json; do "$clast" run charged.yaml --quiet --$format | grep -q spacing && fail "the study's input in $format"; done
expect 0 "$clast" plot charged.db charged.svg --keep-script
says "varied: --x energy"
awk '/^[0-9]/ { n++; if ($6 != "NaN" && ($6 > 1 || $5 < 0)) bad = 1 } END { exit n != 2 || bad }' charged.dat || fail "bars of a share leave 0 to 1: $(cat charged.dat)"
expect 64 "$clast" map charged.db charged.png
says "only energy was varied"
expect 64 "$clast" stats charged.db --by spacing
says "grain.spacing has one value in all points (--studies: also in those of studies and searches). Known are: charge.energy."
expect 0 "$clast" stats charged.db --by spacing --studies

"$clast" materials granite | sed 's/^material: granite/material: own/; s/density: .*/density: 2600 kg\/m^3/' >own.yaml
cat >own-rocks.yaml <<'YAML'
name: own-rocks
scene: basalt-sphere
set: {particles: 200, stop.end_time: 5 us}
vary: {target.material: [./own.yaml, basalt]}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run own-rocks.yaml -j 2 --quiet
head -1 out | tr -s ' ' >rocks-before
expect 0 "$clast" converge own-rocks.yaml --knob particles=100,200 "${study[@]}" -q
expect 0 "$clast" run own-rocks.yaml --quiet
same "$(head -1 out | tr -s ' ')" "$(cat rocks-before)" "columns of rocks"
# Nor does an input whose default follows from the material, once a study has varied it. One that differs between two
# campaigns stays, also where each has other values of what it varies.
expect 0 "$clast" converge own-rocks.yaml --knob stop "${study[@]}" -q --store stop.db
sed 's/\[.*\]/[granite]/; s/5 us/6 us/; s/name: .*/name: later/' own-rocks.yaml >later.yaml
expect 0 "$clast" run own-rocks.yaml --quiet --store stop.db
expect 0 "$clast" stats stop.db --by material
grep -q quiet_time err && fail "an input that follows from the material"
expect 0 "$clast" run later.yaml --quiet --store stop.db
expect 0 "$clast" stats stop.db --by material
says "from row to row the value of stop.end_time changes, too"
expect 0 "$clast" plot stop.db bars.svg -x material # which no line could join
says "clast: from one to the next stop end time changes, too"
expect 0 "$clast" estimates own-rocks.db --studies
same "$(head -1 out | tr -s ' ' | cut -d' ' -f1-5)" "material particles point runs M_1/M" "inputs of rocks and their study"

# What tells two stores apart: a value with a comma is one value, and long values are whole.
long=$(printf "x%.0s" $(seq 110))
for name in dry wet; do
  sed "s/^material: own/material: own, $name/" own.yaml >$name.yaml
  sed "s/, $name/, $name 2/" $name.yaml >${name}2.yaml
  sed "s/^name: .*/name: $name/; s|\[.*\]|[./$name.yaml, ./${name}2.yaml]|" own-rocks.yaml >of-$name.yaml
  expect 0 "$clast" run of-$name.yaml --quiet
  sed "s/, $name//" $name.yaml >$long-$name.yaml
  printf '%s\n' "name: long-$name" 'scene: basalt-sphere' "set: {particles: 200, stop.end_time: 5 us, target.material: ./$long-$name.yaml, projectile.material: ./$long-$name.yaml, impact.angle: $([ $name = dry ] && echo 10 || echo 20) deg}" >long-$name.yaml
  expect 0 "$clast" run long-$name.yaml --quiet
done
expect 64 "$clast" compare dry.db wet.db
says "no common value of target.material.name. Name"
expect 0 "$clast" compare long-dry.db long-wet.db
says "own - $long-wet.yaml), impact.angle (10 deg, 20 deg), projectile.material.name (own - $long-dry.yaml, own - $long-wet.yaml)"

# An input that one store fixes and the other one varies is matched by its value; one that is not in the other scene is
# not.
tiny fixed
sed -i 's/1 ms/0.05 ms, threshold.angle: 4 deg/; /^  threshold.angle/d' fixed.yaml
tiny grid
sed -i 's/1 ms/0.05 ms/; s/2 deg, 6 deg/2 deg, 4 deg/' grid.yaml
tiny impact
sed -i 's/disc-explosion/disc-collision/; s/^set: .*/set: {body.diameter: 8 cm, stop.end_time: 0.05 ms}/; s/threshold.angle: .*/collision.speed: [40 m\/s]/' impact.yaml
for name in fixed grid impact; do
  expect 0 "$clast" run $name.yaml --quiet
done
expect 0 "$clast" compare fixed.db grid.db --csv
same "$(tail -n +2 out | cut -d , -f 1,2 | tr '\n' ' ')" "1,2 2,4 " "common points"
says "without a partner: 2 of 4 points of b (strain 2 %, angle 2 deg; strain 5 %, angle 2 deg)"
expect 0 "$clast" compare grid.db fixed.db --csv
same "$(tail -n +2 out | wc -l)" 2 "common points of the stores the other way round"
# A table has one unit for each input: that of its first store.
sed 's/charge.energy: 2 kJ.m, //; s/^  threshold.strain.*/  charge.energy: [1000 J\/m, 2000 J\/m]/; s/fixed/joule/' fixed.yaml >joule.yaml
sed 's/1000 J/1 kJ/; s/2000 J/2 kJ/; s/joule/kilo/' joule.yaml >kilo.yaml
for name in joule kilo; do expect 0 "$clast" run $name.yaml --quiet; done
expect 0 "$clast" compare joule.db kilo.db
prints "energy 2000 J/m "; ! grep -q "kJ" out || fail "two units in one column"
expect 0 "$clast" merge kinds.db fixed.db own-rocks.db # masses per metre, and whole ones
for of in spectrum exponents; do
  expect 0 "$clast" $of kinds.db
  ! sed '/^clast/d' out | grep -q "kg" || fail "one unit of masses in the plane and in space: $(head -2 out)"
done
expect 0 "$clast" query kinds.db "SELECT upper, density FROM spectra LIMIT 1"
! grep -q "kg" out || fail "one unit of densities in the plane and in space: $(head -2 out)"
for of in "fixed.db upper [kg/m] density [m/kg]" "own-rocks.db upper [kg] density [kg^-1]"; do
  expect 0 "$clast" query ${of%% *} "SELECT upper, density FROM spectra LIMIT 1"
  same "$(sed -n 1p out | tr -s ' ' | sed 's/^ //')" "${of#* }" "units of a spectrum in ${of%% *}"
done
expect 64 "$clast" spectrum kinds.db --picture kinds.png
says "some in the plane, with masses in kg/m"
expect 0 "$clast" spectrum kinds.db --campaign fixed --picture kinds.png
# The difference of an exponent is of the common seeds, too: equal runs have none, whatever others a side has.
sed 's/0.05 ms/1 ms/; s/per_point: 3/per_point: 9/; s/fixed/nine/' fixed.yaml >nine.yaml
sed 's/per_point: 9/per_point: 7/; s/nine/seven/' nine.yaml >seven.yaml
expect 0 "$clast" run nine.yaml --quiet
expect 0 "$clast" run seven.yaml --quiet
expect 0 "$clast" compare nine.db seven.db -Q beta_masses_from_2 --csv
same "$(tail -n +2 out | cut -d , -f 4-6,9 | tr '\n' ' ')" "9,7,7,0 9,7,7,0 " "runs, pairs and difference of an exponent"
expect 64 "$clast" compare fixed.db impact.db
says "only impact.db has collision.speed"
sed 's/^vary: .*/vary: {impact.angle: [10 deg, 20 deg]}/; s/^name: .*/name: one-rock/; s|set: {|set: {target.material: basalt, |' own-rocks.yaml >one-rock.yaml
expect 0 "$clast" run one-rock.yaml --quiet
expect 0 "$clast" run own-rocks.yaml --quiet --store rocks-20.db --set impact.angle=20deg
expect 0 "$clast" compare one-rock.db rocks-20.db --csv
prints '"impact.angle = 0.349065850398866, target.material.name = basalt"'
same "$(tail -n +2 out | cut -d , -f 1,2)" "2,2" "the common point of a material and an angle"

# A store that only a study wrote shows results, and the inputs for which there is room.
expect 0 "$clast" converge charged.yaml --knob time_step,integrator,stop --knob grains=1.2cm,1.069cm "${study[@]}" -q --store studied.db
for of in estimates scatter spectrum exponents; do
  expect 0 "$clast" $of studied.db
  [ "$(LC_ALL=C.UTF-8 wc -L <out)" -le 100 ] || fail "wider than 100 columns"
  sed -n 1,2p out | grep -qE "M_1/M|value|fragments" || fail "no result"
done
expect 0 "$clast" estimates studied.db
says "not shown (--all): "; says "end_time [s]"

# Every column of a question in SQL is shown, in parts where they are too wide.
expect 0 "$clast" query charged.db "select run_id, charge_energy$(printf ", 123456789012345 as 'wide_%s'" $(seq 20)), grain_spacing from runs"
for column in run_id charge_energy wide_1 wide_20 grain_spacing; do tr -d '\n ' <out | grep -q ${column%_*} || fail "the table lacks $column"; done
prints "wide_20"; prints "0.01069"; grep -q "not shown" err && fail "a column of SQL is left out"
[ "$(wc -L <out)" -le 100 ] || fail "wider than 100 columns"

# SQL that asks for too much is a fault of the SQL.
for sql in 'select randomblob(1e18)' 'select zeroblob(2000000000)' "select printf('%.*c', 2000000000, 'x')" "select format('%2000000000d', 1)" "select replace(hex(zeroblob(1e7)), '0', hex(zeroblob(100)))" "select 1 from run limit 'a'"; do
  expect 64 "$clast" query formula.db "$sql"
  grep -q 'bug in clast' err && fail "told as a bug: $sql"
done

# A store whose path is too long for SQLite: 504 bytes work, 505 do not.
part=$(printf 'd%.0s' $(seq 100))
deep=$work/$part/$part/$part/$part
mkdir -p "$deep"
(cd "$deep" && one x)
name=$(printf 'n%.0s' $(seq $((504 - ${#deep} - 1 - 3)))).db
expect 0 "$clast" run "$deep/x.yaml" -j 1 --quiet --store "$deep/$name"
expect 74 "$clast" run "$deep/x.yaml" -j 1 --quiet --store "$deep/n$name"
says "505 bytes"
expect 74 "$clast" export formula.db "$deep/n$name"
says "SQLite opens files with at most"
[ ! -e "$deep/n$name" ] || fail "a file was left behind"

# A material that is named later replaces the one of a file whole.
"$clast" materials granite | sed 's/^material: granite/material: my-granite/' >my.yaml
cat >rock.yaml <<'YAML'
engine: sph
name: rock
kind: impact
target: {shape: sphere, radius: 3 cm, material: ./my.yaml}
projectile: {shape: sphere, radius: 4 mm, material: {name: nylon}}
impact: {speed: 1 km/s}
stop: {end_time: 15 us}
fidelity: {particles: 200}
YAML
m_of() { "$clast" query "$1" "select group_concat(value, ' ') from (select value from point_input where path = 'target.material.weibull.m' order by point_id)" --csv | tail -1; }
printf 'name: rocks\nscene: ./rock.yaml\nvary: {target.material.name: [basalt, gabbro]}\nseeds: {per_point: 1}\n' >rocks.yaml
expect 0 "$clast" run rocks.yaml -j 1 --quiet
same "$(m_of rocks.db)" "8.5 3.0" "Weibull's m of basalt and gabbro"
printf 'name: later\nscene: ./rock.yaml\nset: {target.material.name: gabbro, target.material.weibull.m: 4}\nseeds: {per_point: 1}\n' >later.yaml
expect 0 "$clast" run later.yaml -j 1 --quiet
same "$(m_of later.db)" "4.0" "a value that is set beside the name"
expect 0 "$clast" run later.yaml -j 1 --quiet --store command.db --set target.material.weibull.m=5
same "$(m_of command.db)" "5.0" "a value on the command line"

# So is a change of a file that the campaign names: of its scene, and of one rock among others.
cat >my.yaml <<'YAML'
material: mine
like: granite
density: 2600 kg/m^3
YAML
printf 'name: files\nscene: ./rock.yaml\nvary: {target.material: [basalt, ./my.yaml]}\nseeds: {per_point: 1}\n' >files.yaml
expect 0 "$clast" run files.yaml -j 1 --quiet
sed -i 's/2600/2500/' my.yaml
expect 0 "$clast" run files.yaml -j 1 --quiet
says "target.material.density (2600 kg/m^3 there, 2500 kg/m^3 here) differs"
sed -i 's/2500/2400/' my.yaml
expect 0 "$clast" run files.yaml -j 1 --quiet --store other.db
sed -i 's/2400/2300/' my.yaml
expect 0 "$clast" run files.yaml -j 1 --quiet --store another.db
expect 0 "$clast" merge both.db other.db another.db
says "differ in target.material.density: it is a varied input"
sed -i 's/2300/2500/' my.yaml
sed -i 's/speed: 1 km/speed: 2 km/' rock.yaml
expect 0 "$clast" run files.yaml -j 1 --quiet
says "impact.speed (1000 m/s there, 2000 m/s here) differs"
says "For one form alone"
expect 0 "$clast" estimates files.db
same "$(head -1 out | tr -s ' ' | cut -d " " -f 1-5)" "material speed density point runs" "inputs of changed files"

# Two campaigns of one name: the name takes both, and says that a number takes one.
one twin '' '' 2
sed -i 's/^store: .*//' twin.yaml
expect 0 "$clast" run twin.yaml -j 1 --quiet --store first.db
expect 0 "$clast" run twin.yaml -j 1 --quiet --store second_twin.db --set contact.friction=0.3
expect 0 "$clast" merge twins.db first.db second_twin.db
says "\`clast stats twins.db --campaign 1\` takes one campaign alone; campaigns 1, 2 have one name"
expect 0 "$clast" stats twins.db --campaign twin
says "campaigns 1, 2 of twins.db are called twin: \`twins.db --campaign 1\` takes one alone"
expect 0 "$clast" report twins.db:twin -o twins.html
says "campaigns 1, 2 of twins.db are called twin"
expect 0 "$clast" compare twins.db:twin twins.db:twin
says "campaigns 1, 2 of twins.db are called twin"
expect 0 "$clast" compare twins.db:twin first.db # of twins.db the points with the friction of first.db
expect 0 "$clast" run twin.yaml -j 1 --quiet --store third.db --set contact.friction=0.4
expect 0 "$clast" run twin.yaml -j 1 --quiet --store fourth.db --set contact.friction=0.5
expect 0 "$clast" merge others.db third.db fourth.db
expect 0 "$clast" compare twins.db:twin first.db:twin
says "campaigns 1, 2 of twins.db are called twin"
expect 64 "$clast" compare twins.db:twin others.db:twin
says "Campaigns 1, 2 of twins.db share a name, and so do 1, 2 of others.db: --campaign NUMBER with the stores alone"
expect 64 "$clast" compare twins.db:twin third.db
says "Campaigns 1, 2 of twins.db are called twin: give that store alone with --campaign 1, the other as STORE:CAMPAIGN"
expect 0 "$clast" compare twins.db first.db:twin --campaign 1
expect 0 "$clast" stats twins.db --campaign 1
! grep -q "are called" err || fail "a number takes one"
expect 0 "$clast" stats first.db --campaign twin
! grep -q "are called" err || fail "first.db has one campaign"
one form '' '' 2 # an earlier form of a campaign is no other one
expect 0 "$clast" run form.yaml -j 1 --quiet
one form '' '' 3
expect 0 "$clast" run form.yaml -j 1 --quiet
expect 0 "$clast" stats form.db --campaign form
! grep -q "are called" err || fail "a form is no other campaign"
# One number is another campaign in each store; one name has other numbers.
expect 0 "$clast" compare first.db form.db --campaign 1
says "a and b also differ in campaign (twin, form)"
expect 0 "$clast" merge late.db form.db third.db fourth.db
expect 64 "$clast" compare twins.db:twin late.db:twin
! grep -q "takes this one of both" err || fail "a number of one store alone"
expect 0 "$clast" compare third.db:twin late.db:twin
! grep -q "campaign (" err || fail "one name"

# A changed `set` in the same store is told; the same campaign with more seeds is not.
one changed
expect 0 "$clast" run changed.yaml -j 1 --quiet
one changed '' '' 2
expect 0 "$clast" run changed.yaml -j 1 --quiet
tr '\n' ' ' <err | sed 's/clast: marked (!)[^(]*(clast explain [a-z]*) *//g' >told # so short a run is cut off
silent told
sed -i 's/set: {/set: {contact.friction: 0.3, /' changed.yaml
expect 0 "$clast" run changed.yaml -j 1 --quiet
says "contact.friction ("
says "0.3 here)"
says "other points of this campaign or scene"
# So is an input that differs between campaigns of other names, and --by takes it.
one others '' '' 2
sed -i 's/set: {/set: {contact.friction: 0.4, /; s/^store: .*//' others.yaml
expect 0 "$clast" run others.yaml -j 1 --quiet --store changed.db
expect 0 "$clast" stats changed.db --by friction --csv
same "$(tail -n +2 out | wc -l)" 3 "values of an input that differs between campaigns"

# A link to a store is the store, with its fields beside the file; also a link that leads to no file yet.
one kept 'keep: {fields: all}'
mkdir link
ln -s ../kept.db link/there.db
expect 0 "$clast" run kept.yaml -j 1 --quiet --store link/there.db
one kept 'keep: {fields: all}' '' 3
expect 0 "$clast" run kept.yaml -j 1 --quiet --store link/there.db
same "$(ls link)" "there.db" "files beside the link"
same "$(ls kept-fields | wc -l)" 3 "fields files beside the store"
expect 0 "$clast" check kept.db
expect 0 "$clast" check link/there.db
mkdir merged
expect 0 "$clast" merge merged/all.db link/there.db
expect 0 "$clast" check merged/all.db

# A hard link in another folder: its fields are not computed again.
mkdir hard
ln kept.db hard/link.db
expect 74 "$clast" run kept.yaml -j 1 --quiet --store hard/link.db
says "the folder of its fields"
same "$(ls hard)" "link.db" "files beside the hard link"
expect 65 "$clast" check hard/link.db
prints "the folder of its fields"
same "$(wc -l <out)" 1 "problems of a store whose fields are not found from here"
rm hard/link.db
expect 0 "$clast" run kept.yaml -j 1 --quiet

# A pipe is no store, and nothing waits for its writer.
mkfifo pipe.db
expect 74 timeout -k 1 20 "$clast" run kept.yaml -j 1 --store pipe.db
expect 74 timeout -k 1 20 "$clast" merge pipe.db kept.db

# A fields file that another program has locked can be drawn.
fields=$(ls kept-fields/*.h5 | head -1)
flock -x "$fields" sleep 20 &
holder=$!
sleep 0.3
expect 0 "$clast" picture "$fields" p.png
kill "$holder"

# A second name of a store is the same store, also while it is in use.
ln kept.db second.db
expect 64 "$clast" merge kept.db second.db
says "the same store"
[ ! -e second.db-wal ] || fail "a journal of the second name"
expect 0 "$clast" check kept.db
sqlite3 kept.db 'pragma journal_mode = wal' >/dev/null # as a killed program leaves it
expect 74 "$clast" status second.db
says "a hard link"
[ ! -e second.db-wal ] || fail "a journal of the second name"

# A file system without locks is named.
cat >nolocks.c <<'C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
static int locks(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_GETLK || command == F_OFD_SETLK || command == F_OFD_GETLK;
}
#define WRAP(name)                                                                                                     \
  int name(int file, int command, ...) {                                                                               \
    va_list more;                                                                                                      \
    va_start(more, command);                                                                                           \
    void *argument = va_arg(more, void *);                                                                             \
    va_end(more);                                                                                                      \
    int (*real)(int, int, ...) = dlsym(RTLD_NEXT, #name);                                                              \
    if (!locks(command))                                                                                               \
      return real(file, command, argument);                                                                            \
    errno = ENOLCK;                                                                                                    \
    return -1;                                                                                                         \
  }
WRAP(fcntl)
WRAP(fcntl64)
C
if [ "$sanitized" -eq 0 ]; then
  cc -shared -fPIC -o nolocks.so nolocks.c -ldl
  expect 74 env LD_PRELOAD="$work/nolocks.so" "$clast" status formula.db
  says "no locks"
  expect 74 env LD_PRELOAD="$work/nolocks.so" "$clast" run formula.yaml -j 1 --quiet
  says "no locks"
else
  ok "1"; ok "2" # the sanitizer's library must be loaded first
fi
done_after 162
