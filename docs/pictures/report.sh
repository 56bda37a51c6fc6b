#!/usr/bin/env bash
# Draws the picture of docs/report.md anew: bash docs/pictures/report.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bash tests/page/get_chromium.sh
bash apps/install_dependencies.sh imagemagick
program=$PWD/build/release/bin/clerestory results=$PWD/build/pictures
mkdir -p "$results"
"$program" solve data/scenes/classroom.json -o "$results/classroom.vtp" --quiet
"$program" report "$results/classroom.vtp" -o "$results/classroom.html" --quiet
chromium --headless=new --no-sandbox --user-data-dir="$results/profile" --use-angle=swiftshader --enable-unsafe-swiftshader \
  --hide-scrollbars --window-size=880,1560 --virtual-time-budget=20000 --screenshot="$results/report.png" \
  "file://$results/classroom.html" 2>/dev/null
rm -rf "$results/profile"
convert "$results/report.png" -dither None -colors 255 -define png:compression-level=9 -strip docs/pictures/report.png
