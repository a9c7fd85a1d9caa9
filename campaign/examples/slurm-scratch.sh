#!/bin/bash
#SBATCH --job-name=clast
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
# One campaign, its store on the first node's own disk: `sbatch slurm-scratch.sh campaign.yaml results/campaign.db`.
#
# SQLite needs a disk that locks, and network disks often do not. So the store comes from the network disk at the start
# (stage in), lies on the node's disk while it is written, and goes back at the end (stage out) and every ten minutes.
# What a failing node can lose is what was computed since the last copy; the next job computes it again, to the same
# bits. slurm.sh says how jobs stop and queue themselves again.
campaign=${1:?usage: sbatch slurm-scratch.sh campaign.yaml STORE.db}
store=${2:?usage: sbatch slurm-scratch.sh campaign.yaml STORE.db}
every=${STAGE_OUT_EVERY:-600} # s
export OMP_NUM_THREADS=1

disk=${TMPDIR:-/tmp}/clast-${SLURM_JOB_ID:-$$}
name=$(basename "$store")
fields=${name%.db}-fields # of runs whose fields are kept
mkdir -p "$disk" || exit 74
if [ -e "$store" ]; then
  cp "$store" "$disk/$name" || exit 74
fi

# A whole copy, under its own name only when it is one. Also while ranks compute: clast export reads a running store.
stage_out() {
  (
    flock 9 # two copies at a time would mix
    [ -e "$disk/$name" ] || exit 1
    rm -f "$disk/copy.db" # made in the store's folder, so that paths of fields files stay as they are
    clast export "$disk/$name" "$disk/copy.db" && cp "$disk/copy.db" "$store.part" && mv "$store.part" "$store" || exit 1
    if [ -d "$disk/$fields" ]; then
      cp -ru "$disk/$fields" "$(dirname "$store")/"
    fi
  ) 9>"$disk/lock"
}
(
  trap 'kill $! 2>/dev/null; exit' TERM
  while sleep "$every" & wait $!; do stage_out; done
) &
copier=$!

srun --mpi=pmix --cpu-bind=cores clast run "$campaign" --store "$disk/$name"
status=$?

kill "$copier" 2>/dev/null
wait "$copier"
if stage_out; then
  rm -rf "$disk"
else
  echo "slurm-scratch.sh: the store could not be copied; it is in $disk on $(hostname)" >&2
  exit 74
fi

if [ "$status" -eq 75 ] || [ "$status" -gt 128 ]; then
  restarts=${SLURM_RESTART_COUNT:-0}
  if [ "$restarts" -lt 20 ]; then # a bound, in case every start is killed at once
    scontrol requeue "$SLURM_JOB_ID"
  fi
fi
exit "$status"
