#!/bin/bash
# The shards of the sweep @name@ as one folder, with its report.
#SBATCH --job-name=@name@-merge
#SBATCH --cpus-per-task=@cpus@
#SBATCH --time=@merge_time@
#SBATCH --kill-on-invalid-dep=yes
#SBATCH --output=@folder@/logs/merge.log
@directives@
cd @directory@ || exit 3
@usar@ cluster merge @folder@ --out @out@
status=$?
[ "$status" -le 1 ] || exit "$status" # 1: trials that gave no numbers are rows of the table
@usar@ report @out@ || exit
exit "$status"
