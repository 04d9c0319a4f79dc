#!/usr/bin/env bash
#SBATCH --job-name=agv-mutation
#SBATCH --array=1-32
#SBATCH --cpus-per-task=1
#SBATCH --time=02:00:00
# One shard a task of the array, on a file system that the nodes share. From the folder of the project:
#   tests/proofs/mutation/mutate.py prepare && sbatch tests/proofs/mutation/slurm.sh
# and when all have ended: tests/proofs/mutation/mutate.py merge. A second sbatch goes on where the first one was stopped.
set -euo pipefail
if [[ $SLURM_ARRAY_TASK_MIN-$SLURM_ARRAY_TASK_MAX != 1-$SLURM_ARRAY_TASK_COUNT ]]; then
    echo "slurm.sh: the tasks of the array are to be 1 to N: a second sbatch of all of them does only what is missing" >&2
    exit 2
fi
exec tests/proofs/mutation/mutate.py run --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
