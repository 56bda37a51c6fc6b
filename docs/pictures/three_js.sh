#!/usr/bin/env bash
# Draws the picture of a bake in three.js anew: bash docs/pictures/three_js.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bash tests/page/get_chromium.sh
bash apps/install_dependencies.sh imagemagick
program=$PWD/build/release/bin/clerestory results=$PWD/build/pictures
mkdir -p "$results"
"$program" solve data/scenes/classroom.json -o "$results/classroom.vtp" --quiet
"$program" bake "$results/classroom.vtp" -o "$results/classroom.glb" --exposure 0.5 --quiet
chromium --headless=new --no-sandbox --user-data-dir="$results/profile" --use-angle=swiftshader --enable-unsafe-swiftshader \
  --allow-file-access-from-files --hide-scrollbars --window-size=900,703 --virtual-time-budget=20000 \
  --screenshot="$results/three_js.png" \
  "file://$PWD/docs/pictures/three_js.html?$results/classroom.glb&10.6,6.2,-0.4&4.6,0.2,-4.4" 2>/dev/null
rm -rf "$results/profile"
convert "$results/three_js.png" -crop 900x560+0+0 -dither None -colors 255 -define png:compression-level=9 -strip docs/pictures/three_js.png
