#!/bin/bash
#SBATCH --job-name=clast
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
# One campaign over the tasks of a job: `sbatch slurm.sh campaign.yaml`.
#
# Five minutes before the time limit Slurm sends SIGUSR1 to the ranks: no new runs, the running ones finish (two minutes
# at most), all is committed, and clast ends with 75, "stopped, the same command resumes". The job then queues itself
# again, and the next one goes on from the store. Not tried on a real cluster yet. Sites differ in whether srun passes 75
# on after a signal; a rank killed by one shows as 128 + its number, which is taken as "go on" too. `clast status` tells.
campaign=${1:?usage: sbatch slurm.sh campaign.yaml}
export OMP_NUM_THREADS=1 # one process per core; the farm is the parallelism

srun --mpi=pmix --cpu-bind=cores clast run "$campaign"
status=$?

# 64-66: the command line or the files are wrong, 0: done, 1: done with failed runs: nothing that a requeue would mend.
if [ "$status" -eq 75 ] || [ "$status" -gt 128 ]; then
  restarts=${SLURM_RESTART_COUNT:-0}
  if [ "$restarts" -lt 20 ]; then # an end, should every start be killed at once
    scontrol requeue "$SLURM_JOB_ID"
  fi
fi
exit "$status"
