#!/usr/bin/env bash
# Makes the study of docs/tradeoff.md anew: bash docs/pictures/tradeoff.sh [FOLDER_OF_MODELS [SECONDS]]
# Sweeps every shipped scene, and Duplex_A.ifc where the folder has it; SECONDS is the time of each
# sweep. Draws those docs/pictures/tradeoff_NAME.svg that are there and prints the rows of the table.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=$PWD/build/release/bin/clerestory results=$PWD/build/tradeoff models=${1:-} seconds=${2:-240}
mkdir -p "$results" && rm -f "$results/references.txt"

sweep() {  # NAME INPUT [OPTION...]
  "$program" tradeoff "${@:2}" -o "$results/$1" --time-limit "$seconds" --log "$results/$1.log" >"$results/$1.txt"
  if [ -f "docs/pictures/tradeoff_$1.svg" ]; then cp "$results/$1/tradeoff.svg" "docs/pictures/tradeoff_$1.svg"; fi
  awk -F, -v scene="$1" 'NR > 1 { sub("--accuracy ", "", $2)
    printf "| `%s` | %s | %s | %.1f s | %.1f s | %.0f MB | %s%.3g", scene, $1, $2, $3, $4, $5 / 1e6, $17 ? "below " : "", 100 * $9
    if (!$17) printf " +- %.2g", 100 * $16
    printf " %% | %.3g %% | %.3g %% | %.3g %% | %.3g %% |\n", 100 * $10, 100 * $11, 100 * $13, 100 * $14
    scene = "" }' "$results/$1/tradeoff.csv" | sed 's/^| `` /| /'
  grep 'reference:' "$results/$1.txt" >>"$results/references.txt"
}

for scene in data/scenes/*.json; do sweep "$(basename "$scene" .json)" "$scene"; done
if [ -f "$models/Duplex_A.ifc" ]; then sweep Duplex_A "$models/Duplex_A.ifc" --sky cie-overcast:10000; fi
