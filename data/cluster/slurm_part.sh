#!/usr/bin/env bash
# One part of a year, as a task of a Slurm array. To start eight, and put them together when all are done:
#
#   parts=$(sbatch --parsable --array=1-8 slurm_part.sh)
#   sbatch --dependency=afterok:"$parts" slurm_merge.sh
#
# A part that failed or was killed is run again alone: sbatch --array=3 --export=ALL,PARTS=8 slurm_part.sh
#SBATCH --job-name=year_part
#SBATCH --cpus-per-task=8
#SBATCH --mem=8G
#SBATCH --time=02:00:00
#SBATCH --requeue
set -euo pipefail

scene=${SCENE:-office.json}       # change these: as sbatch's --export has them, or here
weather=${WEATHER:-city.epw}
folder=${FOLDER:-year_parts}      # for all nodes the same place; a new one for each run
parts=${PARTS:-${SLURM_ARRAY_TASK_COUNT:?run this by sbatch --array=1-N}}

mkdir -p "$folder"
exec clerestory annual "$scene" --weather "$weather" --part "$SLURM_ARRAY_TASK_ID/$parts" \
  -o "$folder/part_$SLURM_ARRAY_TASK_ID.vtp" --threads "${SLURM_CPUS_PER_TASK:-0}"
