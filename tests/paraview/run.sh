#!/usr/bin/env bash
# Solves shipped scenes, and opens the results in Debian's ParaView: run.sh PROGRAM FOLDER
set -euo pipefail
program=$1 results=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

rm -rf "$results" && mkdir -p "$results"
for scene in furnace cornell_box office; do
  "$program" solve "$here/../../data/scenes/$scene.json" -o "$results/$scene.vtp" --report "$results/$scene.json" \
    --accuracy draft --quiet --layers
done

bash "$here/pvpython.sh" "$here/open_results.py" "$results"
bash "$here/pvpython.sh" "$here/run_macro.py" "$here/../../data/paraview/clerestory_view.py" "$results/office.vtp" \
  "$results/macro.png"
