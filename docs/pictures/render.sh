#!/usr/bin/env bash
# Draws the pictures of the documentation anew: bash docs/pictures/render.sh [NAME...], NAME a function of render.py
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bash tests/paraview/get_paraview.sh
program=$PWD/build/release/bin/clerestory results=$PWD/build/pictures
mkdir -p "$results"

for scene in house classroom office office_march light_shelf; do
  "$program" solve data/scenes/$scene.json -o "$results/$scene.vtp" --quiet
done
for accuracy in draft standard; do
  "$program" solve data/scenes/cornell_box.json -o "$results/cornell_$accuracy.vtp" --accuracy $accuracy --quiet
done
"$program" solve data/scenes/cornell_box.json -o "$results/elements.vtp" --max-element 0.1 \
  --debug-output "$results/debug" --quiet
"$program" mesh data/scenes/house.json -o "$results/house_patches.vtp" --quiet

bash tests/paraview/pvpython.sh docs/pictures/render.py "$results" docs/pictures "$@"
