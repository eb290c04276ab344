#!/usr/bin/env bash
# A Slurm job array, each task of which draws one part of the image into part_INDEX.exr; no MPI is needed:
#   sbatch --array=0-15 apps/mpi/array_job.sh VOLUME [OPTIONS of freevoxels render]
# Afterwards: freevoxels merge part_*.exr IMAGE
#SBATCH --job-name=freevoxels-part
#SBATCH --time=00:30:00
set -euo pipefail
part=$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN))
exec freevoxels render "$1" "part_$part.exr" --share "$part/$SLURM_ARRAY_TASK_COUNT" --sums "${@:2}"
