#!/usr/bin/env bash
# Draws the pictures of the documentation that clerestory render makes: bash docs/pictures/views.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=$PWD/build/release/bin/clerestory results=$PWD/build/pictures
mkdir -p "$results"

for scene in cornell_box house office office_gloss office_night; do
  "$program" solve data/scenes/$scene.json -o "$results/$scene.vtp" --quiet
done
"$program" render "$results/house.vtp" -o docs/pictures/view_house.png --eye 8.35,0.75,1.65 --target 1.9,2.35,1.0 \
  --fov 75 --size 900x520
"$program" render "$results/office.vtp" -o docs/pictures/view_plan.png --plan 1.2 --show illuminance \
  --isolux 100,200,300,500,750,1000 --range 0:1200 --size 560x700
"$program" render "$results/office_night.vtp" -o docs/pictures/view_night.png --eye 2,4.6,1.5 --target 2,0,1.4 \
  --fov 80 --size 900x480
"$program" render "$results/office_gloss.vtp" -o docs/pictures/view_raytrace.png --eye 3.1,4.6,1.5 --target 1.4,0.4,0.55 \
  --fov 75 --exposure -0.5 --raytrace --size 900x500
"$program" render "$results/cornell_box.vtp" -o docs/pictures/view_fit.png --size 480x400
"$program" render "$results/office.vtp" -o docs/pictures/view_fisheye.png --eye 2,4.6,1.5 --target 2,0,1.4 --fisheye \
  --show luminance --log-scale --size 480x480
"$program" solve data/scenes/polished_ring.json -o "$results/polished_ring.vtp" --quiet
"$program" render "$results/polished_ring.vtp" -o docs/pictures/caustic.png --eye 1.5,0.2,1.6 --target 1.5,1.55,0 \
  --fov 50 --size 780x440 --show illuminance --range 50:600 --log-scale
"$program" render "$results/polished_ring.vtp" -o docs/pictures/view_caustic.png --eye 1.5,0.2,1.6 \
  --target 1.5,1.55,0 --fov 50 --size 780x440 --raytrace
"$program" solve data/scenes/classroom.json -o "$results/classroom_layers.vtp" --layers --quiet
"$program" mix "$results/classroom_layers.vtp" -o "$results/classroom_dimmed.vtp" --set windows=0 --set middle=0.5 --quiet
"$program" render "$results/classroom_dimmed.vtp" -o docs/pictures/view_dimmed.png --plan 1.2 --show illuminance \
  --isolux 50,100,200,300,400 --range 0:500 --size 520x410
