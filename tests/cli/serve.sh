#!/usr/bin/env bash
# `clast serve`: the UM-Bridge protocol 1.0, request by request and error by error (serve.py), limits, the store, the end.
. "$(dirname "$0")/lib.bash"

# served NAME ARGUMENT...: starts a server at a free port; sets pid and url.
served() {
  local name=$1
  shift
  rm -f serve.err # otherwise the port of the previous server may be read
  "$clast" serve "$name.yaml" --port 0 -j 2 "$@" >out 2>serve.err </dev/null &
  pid=$!
  for _ in $(seq 200); do
    port=$(sed -nE 's/^clast: serving at port ([0-9]+) .*/\1/p' serve.err 2>/dev/null || true)
    [ -z "$port" ] || break
    kill -0 $pid 2>/dev/null || { cat serve.err; fail "the server did not start"; }
    sleep 0.05
  done
  [ -n "$port" ] || fail "no port: $(cat serve.err)"
  ! grep -q "other machines" serve.err || fail "a port of this machine alone is called open to others"
  url=http://127.0.0.1:$port
}
ended() { # ended EXIT TEXT: SIGTERM ends the server, and it says so
  local got=0
  kill -TERM $pid
  wait $pid || got=$?
  [ $got -eq "$1" ] || { cat serve.err; fail "the server ended with $got"; }
  grep -qF "$2" serve.err || { cat serve.err; fail "the server did not say: $2"; }
  ok "server ended: $2"
}
client() { # client WHAT...: prints the server's messages together with the client's
  timeout 300 python "$source/tests/cli/serve.py" "$url" "$@" >out 2>err || { cat serve.err; fail "serve.py $1"; }
  ok "serve.py $1"
}

cat >disc.yaml <<'YAML'
name: disc
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.least_time: 1 ms}
vary:
  threshold.strain: [2 %, 5 %]
  threshold.angle: [2 deg, 6 deg]
  beam.young_modulus: {linked: grain.young_modulus, factor: 0.5}
  grain.young_modulus: [1 GPa, 2 GPa]
seeds: {per_point: 3}
store: disc.db
YAML
sed 's/^store: .*/store: grid.db/' disc.yaml >grid.yaml
expect 0 "$clast" run grid.yaml -j 2 --quiet
"$clast" export grid.db points.jsonl --per point --jsonl 2>/dev/null

# ---- every request, every error; answers are those of `clast run`, to the last bit
served disc
client protocol points.jsonl
kept() { [ "$(number disc.db "select count(*) > 0 from runs where counts")" = 1 ]; }
for _ in $(seq 200); do ! kept || break; sleep 0.1; done # answers may come before the store's next commit
kept || fail "no run is kept while it serves"
ok "runs are kept while it serves"
ended 0 "evaluations:"
expect 0 "$clast" check disc.db
same "$(number disc.db "select last_outcome from (select outcome as last_outcome from session order by session_id desc limit 1)")" finished "session"
same "$(number disc.db "select count(*) from estimates where run_id is null and point_id = 1 and headline")" 1 "exponents of a point"
runs=$(number disc.db "select count(*) from runs")

# ---- a second server answers from the store
served disc
client again points.jsonl
client pipelined
ended 0 "0 runs computed"
same "$(number disc.db "select count(*) from runs")" "$runs" "runs after the second server"
expect 0 "$clast" run disc.yaml -j 2 # a campaign continues with the served runs
says "0 runs computed"

# ---- limits: time of an answer, a run's own limit, the end of a server under load
cat >long.yaml <<'YAML'
name: long
scene: disc-explosion
set: {fidelity.time_step: 0.25 us}
vary: {threshold.strain: [2 %, 5 %]}
seeds: {per_point: 1}
limits: {time: 100 s}
store: long.db
YAML
served long --wait 1
client slow
ended 0 "evaluations:"
sed -i 's/100 s/50 ms/; s/long.db/short.db/' long.yaml
served long
client hopeless
ended 0 "1 given up"
same "$(number short.db "select count(*) from attempt where reason = 'time_limit'")" 2 "attempts at a hopeless run"

# ---- the process that starts the runs is killed, as by a system without memory: no normal end
served disc
fork_server=
for _ in $(seq 100); do
  fork_server=$(cat "/proc/$pid/task/$pid/children")
  [ -z "$fork_server" ] || break
  sleep 0.05
done
kill -KILL $fork_server
got=0
wait $pid || got=$?
same "$got" 75 "exit code without a fork server"
cp serve.err err
says "error: no slot is left"
says "the same command resumes"
same "$(number disc.db "select outcome from session order by session_id desc limit 1")" stopped "session without a fork server"

# ---- a token, where several users share a machine
printf 'open-Sesame-7\n' >token
chmod 600 token
served disc --token token
client token open-Sesame-7
ended 0 "evaluations:"

# ---- what cannot be served
chmod 644 token
expect 64 "$clast" serve disc.yaml --port 0 --token token
says "others can read the token"
chmod 600 token
printf '\nlonger\n' >token
expect 65 "$clast" serve disc.yaml --port 0 --token token
expect 66 "$clast" serve disc.yaml --port 0 --token no-such-file
served disc --listen 127.0.0.1
expect 74 "$clast" serve disc.yaml --port "$port"
says "cannot listen at 127.0.0.1, port $port"
expect 74 "$clast" serve disc.yaml --port 0
says "disc.db"
ended 0 "0 evaluations"
expect 64 "$clast" serve disc.yaml --port 0 --listen localhost
expect 64 "$clast" serve disc.yaml --port 0 -Q no_such
expect 64 "$clast" serve disc.yaml --port 70000
sed '/^vary/,/GPa\]/d' disc.yaml >still.yaml
expect 65 "$clast" serve still.yaml --port 0
says "varies nothing"
sed 's/threshold.angle: \[2 deg, 6 deg\]/contact.law: [conservative, printed]/' disc.yaml >law.yaml
expect 65 "$clast" serve law.yaml --port 0
done_after 32
