#!/bin/bash
# The shards of the sweep @name@, one for each task. A task that was stopped goes on where it was when it runs again.
#SBATCH --job-name=@name@
#SBATCH --array=1-@shards@%@at_once@
#SBATCH --cpus-per-task=@cpus@
#SBATCH --time=@time@
#SBATCH --requeue
#SBATCH --signal=B:INT@60
#SBATCH --open-mode=append
#SBATCH --output=@folder@/logs/%a.log
@directives@
cd @directory@ || exit 3

# In the background, so that this shell hears the signal that comes a minute before the time is over.
@usar@ sweep @arguments@ \
    --shard "$SLURM_ARRAY_TASK_ID/@shards@" --out @folder@/"$SLURM_ARRAY_TASK_ID" \
    --jobs "${SLURM_CPUS_PER_TASK:-1}" --quiet &
sweep=$!
trap 'kill -INT "$sweep"' INT
trap 'kill -TERM "$sweep"' TERM
wait "$sweep"
status=$?
while kill -0 "$sweep" 2> /dev/null; do # a signal ended the waiting, not the sweep
    wait "$sweep"
    status=$?
done

case $status in
    1) exit 0 ;; # a trial gave no numbers: it is a row of the table, and the merge names it
    130) scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" ;; # the time is over: once more
esac
exit "$status"
