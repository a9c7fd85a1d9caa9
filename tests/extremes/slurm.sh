#!/usr/bin/env bash
# A real Slurm: a cluster of one node on loopback, from Debian's packages slurm-wlm and munge, in a folder of its own.
# The job script of the guide is requeued on 75 and finishes, also after scontrol requeue, scancel and SIGKILL; no run is
# given up. A job array fills stores that are merged; srun without PMI is refused. The bits are those of one machine.
#
# Needs root, these packages and CLAST_FULL=1.
. "$(dirname "$0")/../cli/lib.bash"
skip() { echo "skipped: $1"; exit 77; }
[ -n "${CLAST_FULL:-}" ] || skip "a long form: set CLAST_FULL=1"
[ "$(id -u)" -eq 0 ] || skip "Slurm's daemons need root"
PATH=$PATH:/usr/sbin
command -v slurmctld slurmd munged >/dev/null || skip "apt-get install slurm-wlm munge"

daemons=()
stop_cluster() {
  local pid
  for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait "${daemons[@]}" 2>/dev/null || true
}
trap '[ "$BASHPID" != $$ ] || { stop_cluster; rm -rf "$work" "$run"; }' EXIT
run=$(mktemp -d /tmp/clast-slurm-XXXXXX) # a socket's name must be short
chmod 755 "$run"
node=$(hostname -s)
head -c 128 /dev/urandom >"$run/key"
chmod 400 "$run/key"
munged --force --foreground --socket="$run/munge" --key-file="$run/key" --pid-file="$run/munged.pid" \
  --seed-file="$run/seed" --log-file="$run/munged.log" 2>"$run/munged.err" &
daemons+=($!)
mkdir "$run/state" "$run/spool"
cat >"$run/slurm.conf" <<END
ClusterName=clasttest
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$run/munge
CredType=cred/munge
StateSaveLocation=$run/state
SlurmdSpoolDir=$run/spool
SlurmctldPidFile=$run/slurmctld.pid
SlurmdPidFile=$run/slurmd.pid
SlurmctldLogFile=$run/slurmctld.log
SlurmdLogFile=$run/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/affinity
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
MpiDefault=none
ReturnToService=2
CommunicationParameters=NoInAddrAny
NodeName=$node NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$run/slurm.conf
for i in $(seq 100); do [ -S "$run/munge" ] && break; sleep 0.1; done
slurmctld -D >"$run/slurmctld.out" 2>&1 &
daemons+=($!)
slurmd -D -N "$node" >"$run/slurmd.out" 2>&1 &
daemons+=($!)
for i in $(seq 300); do
  sinfo -h -o %T 2>/dev/null | grep -q idle && break
  sleep 0.2
done
sinfo -h -o %T >out 2>err || true
grep -q idle out || { tail -n 5 "$run"/*.log "$run"/*.out; fail "the cluster did not start"; }
ok "a cluster of one node: $(sinfo --version)"

# wait_for JOB STATE: until the job has this state
wait_for() {
  local i state
  for i in $(seq 900); do
    state=$(squeue -h -j "$1" -t all -o %T 2>/dev/null || true)
    [ "$state" = "$2" ] && { ok "job is $2"; return; }
    sleep 0.2
  done
  scontrol show job "$1" || true
  cat slurm-*.out 2>/dev/null | tail -n 20
  tail -n 5 "$run"/*.log
  fail "job $1 is $state, expected $2"
}
runs_in() { python -c "import sqlite3, sys; print(sqlite3.connect('file:%s?mode=ro' % sys.argv[1], uri=True).execute('select count(*) from run').fetchone()[0])" "$1" 2>/dev/null || echo 0; }

slow slow
sed -i "/per_point/s/[0-9][0-9]*/$((2 * slow_seeds))/" slow.yaml
expect 0 "$clast" run slow.yaml -j 2 --quiet --store alone.db
bits alone.db >reference.bits
ln -s "$clast" bin/clast # for the job scripts; the folder is in PATH

# The job script of the guide. SIGUSR1 to the job's step is what Slurm sends before the time limit.
cp "$source/campaign/examples/slurm.sh" .
job=$(sbatch --parsable --ntasks=2 --time=10 slurm.sh slow.yaml)
for i in $(seq 600); do [ "$(runs_in slow.db)" -gt 5 ] && break; sleep 0.1; done
before=$(runs_in slow.db)
scancel --signal=USR1 "$job"
wait_for "$job" PENDING
grep -q "Restarts=1" <(scontrol show job "$job") || fail "the job was not requeued"
ok "exit 75 after SIGUSR1: requeued"
stored=$(runs_in slow.db)
[ "$stored" -ge "$before" ] || fail "runs were lost: $before, then $stored"
sleep 5 # slurmd refuses a job that it ended a moment ago
scontrol update JobId="$job" StartTime=now # or Slurm waits two minutes
wait_for "$job" COMPLETED
same_bits slow.db reference.bits "after a requeue"

# A job array: each job has its own points and store; the merged store has all of them.
i=0
for strain in 2 3 5; do
  sed "s/\[2 %, 3 %, 5 %\]/[$strain %]/" slow.yaml >"part-$i.yaml"
  i=$((i + 1))
done
array=$(sbatch --parsable --array=0-2 --ntasks=1 --wrap \
  'clast run part-$SLURM_ARRAY_TASK_ID.yaml --store part-$SLURM_ARRAY_TASK_ID.db -j 1 --quiet')
for part in 0 1 2; do wait_for "${array}_$part" COMPLETED; done
expect 0 "$clast" merge parts.db part-0.db part-1.db part-2.db
same_bits parts.db reference.bits "a merged job array"

# srun: programs that are not connected are refused before they write; pmix connects them; a single program works.
tiny small
for kind in none pmi2; do
  expect 64 srun --mpi=$kind -n 2 "$clast" run small.yaml --quiet
  says "--mpi=pmix"
  [ ! -e small.db ] || fail "--mpi=$kind: a refused program wrote a store"
done
expect 64 srun -n 2 "$clast" run small.yaml --quiet
expect 0 srun --mpi=pmix -n 3 "$clast" run small.yaml --quiet
same "$(number small.db 'select count(*) from run')" 12 "runs by srun --mpi=pmix"
expect 0 "$clast" run small.yaml --quiet --store one.db -j 1
bits one.db >one.bits
same_bits small.db one.bits "srun --mpi=pmix"
expect 0 srun -n 1 "$clast" run small.yaml --quiet --store single.db
same_bits single.db one.bits "srun -n 1"

# The job script again: no run is missing, and it ends immediately.
job=$(sbatch --parsable --ntasks=2 --time=10 slurm.sh slow.yaml)
wait_for "$job" COMPLETED

# begin_job STORE: the job script with a store of its own, until it has some runs
begin_job() {
  sed "s/^store:.*/store: $1.db/" slow.yaml >"$1.yaml"
  job=$(sbatch --parsable --ntasks=2 --time=10 slurm.sh "$1.yaml")
  for i in $(seq 600); do [ "$(runs_in "$1.db")" -gt 5 ] && return; sleep 0.1; done
  fail "job $job stored no runs"
}
# ends_well STORE WHAT: the job ends, no run counts as tried in vain, and the bits are right
ends_well() {
  wait_for "$job" COMPLETED
  same_bits "$1.db" reference.bits "$2"
  same "$(number "$1.db" 'select count(*) from attempt')" 0 "attempts that count against a run, $2"
}
start_again() { # for a job that would wait two minutes
  wait_for "$job" PENDING
  sleep 5 # slurmd refuses a job that it ended a moment ago
  scontrol update JobId="$job" StartTime=now
}

# A task that is killed (the machine's memory is out, say): srun says 137, and the job script requeues.
begin_job killed
tasks=$(scontrol listpids "$job.0" | awk '$4 ~ /^[0-9]+$/ { print $1 }')
[ -n "$tasks" ] || fail "no tasks of job $job: $(scontrol listpids "$job")"
kill -KILL $tasks
start_again
ends_well killed "after SIGKILL to all tasks"

# The administrator, or a job that goes first, sends it back to the queue.
begin_job requeued
scontrol requeue "$job"
start_again
ends_well requeued "after scontrol requeue"

# The user cancels it, and submits it again.
begin_job cancelled
scancel "$job"
wait_for "$job" CANCELLED
[ "$(runs_in cancelled.db)" -lt "$(runs_in alone.db)" ] || fail "the job was over before scancel"
job=$(sbatch --parsable --ntasks=2 --time=10 slurm.sh cancelled.yaml)
ends_well cancelled "after scancel"
done_after 33
