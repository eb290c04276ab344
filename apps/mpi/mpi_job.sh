#!/usr/bin/env bash
# A Slurm job that draws one image with all tasks of its allocation:
#   sbatch --nodes 8 --ntasks-per-node 4 [--gpus-per-node 4] apps/mpi/mpi_job.sh VOLUME IMAGE [OPTIONS of freevoxels render]
#SBATCH --job-name=freevoxels
#SBATCH --time=00:30:00
set -euo pipefail
# A rank that is killed ends the others, which would wait for it.
exec srun --mpi=pmix --kill-on-bad-exit=1 freevoxels-mpi render "$@"
