#!/usr/bin/env bash
# Bad input and extremes of engine sph on the command line: a clear error with file, line and remedy and the right exit code, or a
# run with an honest status.
. "$(dirname "$0")/../cli/lib.bash"

small=(--set fidelity.particles=200 --set fidelity.projectile_spacing=0.7)
write() { printf '%b' "engine: sph\n$1\n" >scene.yaml; }
refuse() { # CODE WORD: scene.yaml is refused
  expect "$1" "$clast" simulate ./scene.yaml --seed 1
  says "$2"
}

write 'target: {material: {density: 3 GPa}}';                       refuse 65 "scene.yaml:2:30"
says "kg/m^3"
write 'target: {material: {name: basalr}}';                          refuse 65 "did you mean 'basalt'"
write 'target: {fracture: on, material: {name: aluminium}}';         refuse 65 "target.material.weibull.m is needed because fracture is on"
says "target.fracture: off"
write 'target: {material: {name: custom}}';                          refuse 65 "target.material 'custom' lacks density, melt_energy"
write 'fidelity: {particles: 0}';                                    refuse 65 "fidelity.particles"
write 'fidelity: {particles: 2e9}';                                  refuse 65 "fidelity.particles"
write 'impact: {speed: -1 m/s}';                                     refuse 65 "impact.speed"
write 'impact: {speed: 3 cm}';                                       refuse 65 "m/s"
write 'impact: {gap: 1 km}\nstop: {end_time: 1 ms}';                                         refuse 65 "impact.gap"
write 'target: {shape: cylinder, radius: 2 cm, inner_radius: 1 cm}'; refuse 65 "misses"
write 'kind: collision\ntarget: {shape: cylinder, length: 1 cm}\ncollision: {gap: 0}'; refuse 65 "overlap"
write 'target: {radius: .nan}';                                      refuse 65 "target.radius"
write 'target: {material: {weibull: {m: 0.9}}}';                     refuse 65 "weibull.m"
write 'stop: {end_time: 0}';                                         refuse 65 "stop.end_time"

# More particles than memory: refused with the number, at once and before anything is allocated. (The sanitizers themselves need
# terabytes of address space; there the machine's own memory is the bound.)
write 'fidelity: {particles: 1000000000}'
([ "$sanitized" -ne 0 ] || ulimit -v 4000000; timeout 20 "$clast" simulate ./scene.yaml --seed 1 >out 2>err) && fail "1e9 particles were run"
says "GB of memory"
ok "more particles than memory"

# Any speed, size and flaws: a run with a status.
for change in impact.speed=0 "impact.speed=70 km/s" target.radius=1um target.radius=1000km "target.material.weibull.k=1e200 1/m^3" \
  target.material.weibull.m=1 target.material.weibull.m=200; do
  write "projectile: {radius: $([[ $change == target.radius=1um ]] && echo 0.3 um || { [[ $change == target.radius=1000km ]] && echo 300 km || echo 1 cm; })}"
  got=0
  timeout 100 "$clast" simulate ./scene.yaml --seed 1 "${small[@]}" --set "$change" --json >out 2>err || got=$?
  [ "$got" -eq 0 ] || [ "$got" -eq 1 ] || fail "exit $got with $change"
  grep -q '"state"' out || fail "no state with $change"
  ! grep -qi 'nan' out || fail "NaN with $change"
  ok "$change: exit $got"
done

# Axes that differ by case alone (Tillotson's A and a) keep their columns apart.
cat >ab.yaml <<'Y'
name: ab
scene: basalt-sphere
vary: {target.material.tillotson.A: [20 GPa, 26.7 GPa], target.material.tillotson.a: [0.4, 0.5]}
set: {fidelity.particles: 200, fidelity.projectile_spacing: 0.5, stop.end_time: 10 us}
store: ab.db
Y
expect 0 "$clast" run ab.yaml
expect 0 "$clast" query ab.db "select count(distinct point_id) as n from point_input where path = 'target.material.tillotson.a'" --csv
prints 4
expect 0 "$clast" check ab.db

# Bits belong to a CPU class: a replay in another class differs, and replay gives the reason.
class=$("$clast" query ab.db "select json_extract(facts, '$.cpu_class') from session" --csv | tail -n 1)
expect 0 "$clast" replay ab.db 1
if [ "$class" = baseline ]; then
  ok "no other class of CPU here"
else
  expect 65 env CLAST_CPU=baseline "$clast" replay ab.db 1
  says "CLAST_CPU=$class"
fi

# Inputs that only prove impossible when bodies are made (a damping layer thinner than a particle): a run of state invalid, which
# has no body to draw or to keep. The reason is told, and not the picture's; a file that stands there from before is not taken for
# the run's; a campaign that keeps fields does not miss any.
layer=(--set fidelity.graded=false --set fidelity.particles=3000 --set fidelity.projectile_spacing=0.1
  --set sides.far=damped --set sides.depth='0.1 mm')
echo "of before" >graded.hdf
for leave in --picture=graded.png --fields=graded.hdf; do
  expect 1 "$clast" simulate gabbro-crater "${layer[@]}" "$leave" --json
  prints '"invalid"'; says "holds no particle"; one_error
done
expect 1 "$clast" simulate gabbro-crater "${layer[@]}" --fields graded.hdf --picture graded.png
says "holds no particle"; one_error
same "$(cat graded.hdf)" "of before" "a file of before"
[ -z "$(ls | grep -F graded.png)" ] || fail "a picture of nothing, or its leavings"
cat >graded.yaml <<'Y'
name: graded
scene: gabbro-crater
set: {fidelity.graded: false, fidelity.particles: 3000, fidelity.projectile_spacing: 0.1, sides.far: damped, sides.depth: 0.1 mm}
seeds: {per_point: 2}
keep: {fields: all}
store: graded.db
Y
for time in first again; do
  expect 1 "$clast" run graded.yaml
  expect 0 "$clast" check graded.db
done
same "$("$clast" query graded.db "select count(*) from run where fields_path is not null" --csv | tail -n 1)" 0 "fields of invalid runs"
expect 0 "$clast" replay graded.db 1 --fields graded.h5
says "has no fields"
done_after 37
