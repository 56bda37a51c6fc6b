#!/usr/bin/env bash
# Draws the pictures of the documentation anew: bash docs/pictures/render.sh [NAME...], NAME a function of render.py
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bash tests/paraview/get_paraview.sh
program=$PWD/build/release/bin/clerestory root=$PWD/build/paraview/root results=$PWD/build/pictures
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

exec 3< <(exec Xvfb -displayfd 1 -noreset -nolisten tcp 2>"$results/xvfb.log")
screen=$!
trap 'kill $screen' EXIT
read -r -u 3 number || { cat "$results/xvfb.log" >&2; exit 1; }
DISPLAY=:$number PYTHONPATH=$root/usr/lib/python3/dist-packages \
  LD_LIBRARY_PATH=$root/lib/$(uname -m)-linux-gnu:$root/usr/lib/$(uname -m)-linux-gnu \
  "$root/usr/bin/pvpython" --force-offscreen-rendering docs/pictures/render.py "$results" docs/pictures "$@"
