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
# Five minutes before the time limit Slurm sends SIGUSR1 to the ranks. clast then starts no new runs, waits for the
# running ones (two minutes at most), commits all results and ends with 75: "stopped, the same command resumes". The job
# queues itself again, and the next one goes on from the store. `clast status` shows how far it is. --time must be well
# above these 300 s. Slurm starts a requeued job after two minutes at the earliest.
# Tried with Slurm of Debian 12 on one node (tests/extremes/slurm.sh): requeue after SIGUSR1 and after SIGKILL, finish;
# not on a larger cluster. Debian's Open MPI 4.1 knows --mpi=pmix only: with --mpi=none and pmi2 the ranks do not find each other, and
# clast ends with 64. Sites differ in whether srun passes 75 on after a signal. A rank that a signal killed shows as 128
# + its number; the script requeues then, too.
campaign=${1:?usage: sbatch slurm.sh campaign.yaml}
export OMP_NUM_THREADS=1 # one process per core; the farm is the parallelism

srun --mpi=pmix --cpu-bind=cores clast run "$campaign"
status=$?

# A requeue does not help with 0 (done), 1 (done, with failed runs) and 64 to 66 (wrong command line or files).
if [ "$status" -eq 75 ] || [ "$status" -gt 128 ]; then
  restarts=${SLURM_RESTART_COUNT:-0}
  if [ "$restarts" -lt 20 ]; then # a bound, in case every start is killed at once
    scontrol requeue "$SLURM_JOB_ID"
  fi
fi
exit "$status"
