#!/bin/bash
#SBATCH --job-name=clast-part
#SBATCH --array=0-9
#SBATCH --cpus-per-task=32
#SBATCH --time=12:00:00
# Parts of one campaign as jobs of their own, without MPI: `sbatch slurm-array.sh campaign.yaml points.csv`.
#
# The campaign has `design: {file: points.csv}`. Task k of n takes every n-th point, and writes part-k.db on the disk where
# it was started. Then: clast merge campaign.db part-*.db. Runs are known by identity, so a part that is computed twice, or
# merged twice, adds nothing; a failed task is given again alone: sbatch --array=3 slurm-array.sh ...
campaign=${1:?usage: sbatch slurm-array.sh campaign.yaml points.csv}
points=${2:?usage: sbatch slurm-array.sh campaign.yaml points.csv}
part=${SLURM_ARRAY_TASK_ID:?not in a job array}
first=${SLURM_ARRAY_TASK_MIN:-0} count=${PARTS:-${SLURM_ARRAY_TASK_COUNT:?}}

folder=part-$part
mkdir -p "$folder"
cp "$campaign" "$folder/campaign.yaml"
# The header, and the points of this part. The campaign names its file of points; here it is this one.
awk -v part="$((part - first))" -v count="$count" \
  '/^#/ || !NF { next } !header { header = 1; print; next } n++ % count == part' "$points" >"$folder/points.csv"
sed -i 's/^design:.*/design: {file: points.csv}/' "$folder/campaign.yaml"
exec clast run "$folder/campaign.yaml" --store "part-$part.db" -j "${SLURM_CPUS_PER_TASK:-0}" --quiet
