#!/usr/bin/env bash
# Puts the parts of slurm_part.sh together; see there.
#SBATCH --job-name=year_merge
#SBATCH --mem=8G
#SBATCH --time=00:30:00
set -euo pipefail

folder=${FOLDER:-year_parts}      # that of slurm_part.sh
exec clerestory merge "$folder"/part_*.vtp -o "${OUT:-year.vtp}"
