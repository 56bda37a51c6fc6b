#!/usr/bin/env bash
# Makes the study of docs/tradeoff.md anew: bash docs/pictures/tradeoff.sh [FOLDER_OF_MODELS [SECONDS]]
# Sweeps every shipped scene, and Duplex_A.ifc and zdm2.glb where the folder has them; SECONDS is the time of each
# sweep. Draws docs/pictures/tradeoff_NAME.svg and prints the tables.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=$PWD/build/release/bin/clerestory results=$PWD/build/tradeoff models=${1:-} seconds=${2:-240}
mkdir -p "$results"

sweep() {  # NAME INPUT [OPTION...]
  "$program" tradeoff "${@:2}" -o "$results/$1" --time-limit "$seconds" --log "$results/$1.log" >"$results/$1.txt"
  cp "$results/$1/tradeoff.svg" "docs/pictures/tradeoff_$1.svg"
  printf '\n### %s\n' "$1"
  tail -n 2 "$results/$1.txt" | head -n 1
  echo '| method | accuracy | wall | CPU | memory | rms, worst room | p95 | bias | said rms |'
  echo '|---|---|---|---|---|---|---|---|---|'
  awk -F, 'NR > 1 { sub("--accuracy ", "", $2)
    printf "| %s | %s | %.1f s | %.1f s | %.0f MB | %s%.2g +- %.2g %% | %.2g %% | %.2g %% | %.2g %% |\n", $1, $2, $3, $4,
      $5 / 1e6, $17 ? "below " : "", 100 * $9, 100 * $16, 100 * $11, 100 * $13, 100 * $14 }' "$results/$1/tradeoff.csv"
}

for scene in data/scenes/*.json; do sweep "$(basename "$scene" .json)" "$scene"; done
if [ -f "$models/Duplex_A.ifc" ]; then sweep Duplex_A "$models/Duplex_A.ifc" --sky cie-overcast:10000; fi
if [ -f "$models/zdm2.glb" ]; then sweep zdm2 "$models/zdm2.glb" --sky cie-overcast:10000; fi
