#!/usr/bin/env bash
# The job scripts of campaign/examples with substitutes for srun and scontrol: stage in and out, requeue, arrays and merge.
. "$(dirname "$0")/lib.bash"
mkdir -p bin node net
cat >bin/srun <<'SH'
#!/bin/sh
while [ "${1#--}" != "$1" ]; do shift; done
echo "srun $*" >>"$JOBS"
"$@" -j 2 --quiet
code=$?
[ -e "$JOBS.stop" ] && { rm "$JOBS.stop"; exit 75; }
exit $code
SH
cat >bin/scontrol <<'SH'
#!/bin/sh
echo "scontrol $*" >>"$JOBS"
SH
chmod +x bin/srun bin/scontrol
ln -s "$clast" bin/clast
export PATH=$work/bin:$PATH JOBS=$work/jobs TMPDIR=$work/node SLURM_JOB_ID=7
examples=$source/campaign/examples

# ---- slurm-scratch.sh: the store and the fields come back; the node's disk is left clean; the next job goes on
tiny net "keep: {fields: {first: 1}}"
sed -i 's/{fields: {first: 1}}/{fields: first 1}/; s/per_point: 3/per_point: 2/' net.yaml
touch jobs.stop
expect 75 bash "$examples/slurm-scratch.sh" net.yaml net/results.db
same "$(grep -c '^scontrol requeue 7$' jobs)" 1 "requeued"
expect 0 "$clast" check net/results.db
same "$(number net/results.db 'select count(*) from run')" 8 "runs that came back"
same "$(ls net/results-fields | wc -l) $(ls -A node | wc -l)" "4 0" "fields came back, the node is clean"
sed -i 's/per_point: 2/per_point: 3/' net.yaml
expect 0 bash "$examples/slurm-scratch.sh" net.yaml net/results.db
same "$(number net/results.db 'select count(*) from run') $(number net/results.db 'select count(*) from session')" "12 2" "runs and sessions after the second job"
expect 0 "$clast" check net/results.db
# a copy made during the job is complete, and the last copy is kept
sed -i 's/per_point: 3/per_point: 10/' net.yaml
STAGE_OUT_EVERY=0.03 expect 0 bash "$examples/slurm-scratch.sh" net.yaml net/results.db
same "$(number net/results.db 'select count(*) from run')" 40 "runs after many copies"
[ ! -e net/results.db.part ] || fail "a part of a copy is left"
# files that cannot be copied stay in their place, and the job prints the place
expect 74 bash "$examples/slurm-scratch.sh" net.yaml none/results.db
says "it is in $work/node/clast-7"
[ -s node/clast-7/results.db ] || fail "the store is gone"
rm -r node/clast-7

# ---- slurm-array.sh: the parts together are the whole
cat >parts.yaml <<'YAML'
name: parts
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 2 kJ/m, stop.end_time: 1 ms}
design: {file: points.csv}
seeds: {per_point: 2}
store: whole.db
YAML
printf '# five points\nthreshold.strain [%%],threshold.angle [deg]\n2,2\n3,2\n\n4,2\n5,6\n2,6\n' >points.csv
expect 0 "$clast" run parts.yaml -j 2 --quiet
export SLURM_ARRAY_TASK_MIN=0 SLURM_ARRAY_TASK_COUNT=3 SLURM_CPUS_PER_TASK=1
for task in 0 1 2 1; do SLURM_ARRAY_TASK_ID=$task expect 0 bash "$examples/slurm-array.sh" parts.yaml points.csv; done
same "$(for k in 0 1 2; do number part-$k.db 'select count(*) from point'; done | tr '\n' ' ')" "2 2 1 " "points of the parts"
expect 0 "$clast" merge merged.db part-*.db
same "$("$clast" query merged.db "select identity, largest_fraction from runs order by 1" --csv | md5sum)" \
  "$("$clast" query whole.db "select identity, largest_fraction from runs order by 1" --csv | md5sum)" "the parts and the whole"

for script in slurm slurm-scratch slurm-array; do expect 0 bash -n "$examples/$script.sh"; done
done_after 22
