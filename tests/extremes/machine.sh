#!/usr/bin/env bash
# Faults of the machine, not of a run: signals from outside, full disks, a store that is moved away, a launcher without
# MPI. No run is given up because of them: the same command computes the missing runs with the reference's bits.
. "$(dirname "$0")/../cli/lib.bash"
ask() { python -c "import sqlite3, sys; print(sqlite3.connect('file:%s?mode=ro' % sys.argv[1], uri=True).execute(sys.argv[2]).fetchone()[0])" "$1" "$2"; }

clast=$toy
waiting slow
expect 0 "$clast" run slow.yaml -j 2 --quiet
bits slow.db >reference.bits
runs_in() { ask "$1" 'select count(*) from run' 2>/dev/null || echo 0; }
# begin STORE COMMAND...: in the background, in a process group of its own, until the store has another run
begin() {
  local store=$1 i before
  before=$(runs_in "$1")
  shift
  setsid env --default-signal=INT,TERM,USR1 "$@" >out 2>err &
  pid=$!
  for i in $(seq 600); do
    [ "$(runs_in "$store")" -gt "$before" ] && return
    sleep 0.05
  done
  fail "no other run after 30 s"
}
ends() { # ends CODE WHAT
  local got=0
  wait "$pid" || got=$?
  [ "$got" -eq "$1" ] || fail "exit $got, expected $1: $2"
  ok "exit $1: $2"
}

# SIGTERM to the whole process group, in three sessions. Nothing counts as failed. Twice: `timeout`, scancel. Between
# SIGSTOP and SIGCONT: a job that is suspended for another one, and what systemd sends.
cp slow.yaml term.yaml
echo 'limits: {attempts: 1}' >>term.yaml
for signals in "TERM TERM" "TERM TERM" "STOP TERM CONT"; do
  begin term.db "$clast" run term.yaml --store term.db -j 1
  for signal in $signals; do kill "-$signal" -- "-$pid" 2>/dev/null || true; sleep 0.2; done
  ends 75 "SIG$signals to the process group"
done
same "$(ask term.db 'select count(*) from attempt')" 0 "attempts that failed"
expect 0 "$clast" run term.yaml --store term.db -j 2 --quiet
same_bits term.db reference.bits "after these signals"

# kill -9 of the processes that compute, as the kernel does when memory is out: tried again, never given up for good
sed 's/per_point: .*}/per_point: 1}/; s/vary:.*/set: {wait: 100 s}\nlimits: {attempts: 1}/' slow.yaml >killed.yaml
setsid "$clast" run killed.yaml --store killed.db -j 1 >out 2>err &
pid=$!
below() { [ -z "$1" ] || pgrep -d , -P "$1" || true; }
victim=
for i in $(seq 600); do # the slot, its fork server, the run
  victim=$(below "$(below "$(below "$pid")")")
  [ -n "$victim" ] && break
  sleep 0.05
done
kill -9 "$victim"
ends 75 "a run whose process was killed from outside"
says "the same command"
same "$(ask killed.db "select count(*) || ' ' || min(reason) from attempt")" "1 lost" "attempt in the store"
cp slow.db lost.db # as if every run had been lost three times, and none computed
python - <<'PY'
import sqlite3
d = sqlite3.connect('lost.db')
d.execute("insert into attempt (identity, point_id, replicate, seed, number, reason, exit_code, signal, wall_time, peak_memory, limited_to, message, host, rank, failed_at) "
          "select identity, point_id, replicate, seed, n, 'lost', 0, 15, 1, 0, 0, 'terminated', 'h', 0, 1.0 from run, (select 1 as n union select 2 union select 3)")
for table in ('fragment_mass', 'spectrum', 'estimate', 'result_toy', 'run', 'point_estimate', 'point_total', 'point_spectrum'):
    d.execute(f'delete from {table}')
d.execute('drop table table_digest') # as a store of version 3, which has no numbers of rows
d.execute('pragma user_version = 3')
d.commit()
PY
expect 0 "$clast" run slow.yaml --store lost.db -j 2 --quiet
same_bits lost.db reference.bits "runs that were lost three times each"

# a disk that is full when fields are written: the results are kept, 74, and the same command writes the fields
# (fields of 0.8 MB each, a store of 0.2 MB)
cat >fields.yaml <<YAML
name: fields
scene: disc-explosion
set: {body.diameter: 45 cm, charge.energy: 6 kJ/m, stop.end_time: 0.2 ms}
vary: {threshold.strain: [2 %]}
seeds: {per_point: 2}
keep: {fields: all}
YAML
expect 0 "$clast" run fields.yaml --store whole.db -j 2 --quiet
bits whole.db >fields.bits
expect 74 bash -c "ulimit -f 500; '$clast' run fields.yaml --store fields.db -j 2"
says "fields"
says "same command"
same "$(ask fields.db 'select count(*) from attempt')" 0 "attempts that failed"
[ "$(ask fields.db 'select count(*) from run')" -ge 1 ] || fail "the computed result was thrown away"
same "$(ask fields.db 'select count(fields_path) from run')" 0 "fields written"
expect 0 "$clast" run fields.yaml --store fields.db -j 2 --quiet
same "$(ask fields.db 'select count(fields_path) from run')" 2 "fields written by the same command"
same_bits fields.db fields.bits "after a full disk"
for file in fields-fields/*.h5; do cmp -s "$file" "whole-fields/$(basename "$file")" || fail "$file differs"; done
ok "the fields are those of a run without a full disk"

# the same on one small disk with the store: what is said to be stored is stored (mounting needs root)
mkdir small
if mount -t tmpfs -o size=1500k none small 2>err; then
  trap '[ "$BASHPID" != $$ ] || { umount "$work/small"; rm -rf "$work"; }' EXIT
  sed 's/per_point: 2/per_point: 12/; s/45 cm/30 cm/' fields.yaml >small.yaml
  expect 74 "$clast" run small.yaml --store small/s.db -j 2 --quiet
  ! grep -qF "The results are stored" err || [ "$(ask small/s.db 'select count(*) from run')" -ge 1 ] || fail "not stored"
  ok "results beside fields that fill the disk"
else
  ok "no right to mount: skipped"; ok "skipped"
fi

# a limit on file sizes (ulimit -f, SIGXFSZ) counts as a full disk: a message, exit code 74
tiny tiny
sed -i 's/per_point: 3/per_point: 600/' tiny.yaml
expect 74 bash -c "ulimit -f 700; '$clast' run tiny.yaml -j 2 --quiet"
one_error

# too few open files: the message says so, and the same command goes on
tiny tiny
rm -f tiny.db*
expect 74 bash -c "ulimit -n 7; exec '$clast' run tiny.yaml --quiet 3>&- 4>&- 5>&- 6>&-"
says "ulimit -n 1024"
expect 0 "$clast" run tiny.yaml --quiet

# a device that is full is named
expect 74 "$clast" export tiny.db /dev/full --per run
says "/dev/full"

# a store that is moved, removed or replaced under a running campaign
for how in moved removed replaced; do
  begin $how.db "$clast" run slow.yaml --store $how.db -j 2
  case $how in
    moved) mv moved.db elsewhere.db ;;
    removed) rm removed.db ;;
    replaced) cp slow.db other.db; mv other.db replaced.db ;;
  esac
  ends 74 "the store was $how"
  says "moved, removed or replaced"
done
cmp -s slow.db replaced.db || fail "the file that took the store's place was written"
expect 0 "$clast" check elsewhere.db

# names that SQLite treats as a database in memory
for name in :memory: "file::memory:?mode=memory" "file:x.db?mode=memory" ""; do
  expect 64 "$clast" run slow.yaml --store "$name" --quiet
  one_error
done
[ ! -e :memory: ] || fail "a file called :memory:"

# a copy without the -wal file of a store that is being written
begin writing.db "$clast" run slow.yaml --store writing.db -j 2
cp writing.db copy.db
kill -INT "$pid"; ends 75 "the store that was copied"
got=0
"$clast" check copy.db >out 2>err || got=$?
[ "$got" -eq 65 ] || fail "check of a copy without its -wal: $got"
grep -q -- "-wal" out err || fail "it does not say what is missing"
ok "a copy without its -wal is said to be one"
expect 65 "$clast" status copy.db
says "-wal"
expect 65 "$clast" merge merged.db copy.db
expect 0 "$clast" merge copy.db writing.db
says "clast: warning: copy.db has no -wal"
expect 0 "$clast" check copy.db

# programs that a launcher started side by side without MPI: refused before anything is written
# (Open MPI keeps memory: leaks are not checked)
for launcher in "SLURM_STEP_NUM_TASKS=4 SLURM_PROCID=0" "PMI_RANK=0 PMI_SIZE=4 ASAN_OPTIONS=detect_leaks=0"; do
  expect 64 env $launcher "$clast" run slow.yaml --store single.db --quiet
  says "--mpi=pmix"
  expect 64 env ${launcher/=0/=1} "$clast" run slow.yaml --store single.db --quiet
done
[ ! -e single.db ] || fail "one of several programs began to write"
expect 0 env SLURM_STEP_NUM_TASKS=1 SLURM_PROCID=0 "$clast" run slow.yaml --quiet
expect 0 env SLURM_STEP_NUM_TASKS=4 SLURM_PROCID=0 mpirun --oversubscribe -n 2 "$clast" run slow.yaml --quiet

# Shared memory of ranks that were killed goes when the next farm starts; not what a process still uses, and not what
# may belong to ranks that are starting.
segment() { echo "/dev/shm/vader_segment.$(hostname).$(id -u).test$$.$1"; }
for kind in dead used young; do head -c 4096 /dev/zero >"$(segment $kind)"; done
touch -d '5 minutes ago' "$(segment dead)" "$(segment used)"
python -c "
import mmap, sys, time
with open(sys.argv[1], 'r+b') as file:
    kept = mmap.mmap(file.fileno(), 0)
print('mapped', flush=True)
time.sleep(60)" "$(segment used)" >mapped 2>/dev/null &
user=$!
until [ -s mapped ]; do sleep 0.05; done
expect 0 mpirun --oversubscribe -n 2 "$clast" run slow.yaml --quiet
left=$(cd /dev/shm && echo vader_segment.*."test$$".*)
kill "$user"
rm -f "$(segment used)" "$(segment young)" "$(segment dead)"
same "${left//"vader_segment.$(hostname).$(id -u).test$$."/}" "used young" "shared memory that is left"

# targets that are no plain files are written, not replaced
mkfifo pipe
cat pipe >piped.bits & reader=$!
expect 0 "$clast" export slow.db pipe --bits
[ -p pipe ] || fail "export replaced the pipe by a file"
wait "$reader"
cmp -s piped.bits reference.bits || fail "other bits through the pipe"
ok "export writes into a pipe"

# Threads that the system refuses: fewer compute the same bits. A limit of memory leaves room for their stacks. Root may
# have as many processes as it wants, so a user without a name asks (who may not enter our folder).
clast=$build/clast
tight() { # tight NAME LIMIT
  printf 'name: %s\nscene: basalt-sphere\nset: {fidelity.particles: 3000, stop.end_time: 3 us, fidelity.threads: 8}\n' "$1"
  printf 'limits: {memory: %s, attempts: 1}\nseeds: {per_point: 1}\n' "$2"
}
tight many "2 GiB" >many.yaml
tight few "40 MiB" >few.yaml
expect 0 "$clast" run many.yaml --quiet
bits many.db >many.bits
if [ "$sanitized" -eq 0 ]; then
  expect 0 "$clast" run few.yaml --quiet
  same_bits few.db many.bits "with a limit of memory near the need"
else
  ok "the sanitizers take address space"; ok "skipped"
fi
if [ "$sanitized" -eq 0 ] && [ "$(id -u)" -eq 0 ] && open=$(mktemp -d); then
  chmod 777 "$open"
  cp "$clast" many.yaml "$open"
  for slot in "" --in-process; do
    expect 0 env -C "$open" setpriv --reuid=45678 --regid=45678 --clear-groups prlimit --nproc=6 ./clast run many.yaml --store "few$slot.db" -j 1 --quiet $slot
    same_bits "$open/few$slot.db" many.bits "with six processes and threads $slot"
  done
  rm -r "$open"
else
  for check in 1 2 3 4; do ok "only root becomes another user, and the sanitizers take processes: skipped $check"; done
fi
clast=$toy

# a path that SQLite does not open, and the longest that it does
long=$(printf 'd%.0s' $(seq 200))
mkdir -p "$long/$long/$long"
expect 74 "$clast" run slow.yaml --store "$long/$long/$long/s.db" -j 2 --quiet
says "SQLite opens files with at most 504"
same "$(ls -A "$long/$long/$long")" "" "files beside a refused store"
here=$(pwd -P)/$long
longest=$(printf 's%.0s' $(seq $((504 - ${#here} - 4)))) # with a slash and .db
[ ${#longest} -le 244 ] || { mkdir "$long/${longest::100}"; longest=${longest::100}/${longest:101}; }
expect 0 "$clast" run slow.yaml --store "$long/$longest.db" -j 2 --quiet
expect 74 "$clast" run slow.yaml --store "$long/${longest}s.db" -j 2 --quiet
name=$(printf 'n%.0s' $(seq 244)) # with .db and -journal 255 bytes, the longest name of a file
expect 0 "$clast" run slow.yaml --store "$name.db" -j 2 --quiet
expect 74 "$clast" run slow.yaml --store "n$name.db" -j 2 --quiet
says "its name has 248 bytes"

# a benchmark that gets SIGTERM ends
"$build/tests/bench/bench_farm_program" 1 farm >out 2>err &
pid=$!
sleep 1.5; kill -TERM "$pid"
got=0; wait "$pid" || got=$?
case $got in 75 | 143) ok "bench_farm ended with $got after SIGTERM" ;; *) fail "bench_farm ended with $got after SIGTERM" ;; esac
done_after 63
