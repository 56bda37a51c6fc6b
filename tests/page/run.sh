#!/usr/bin/env bash
# Solves shipped scenes, makes their pages and opens them in Chromium: run.sh PROGRAM FOLDER. Ends with 77 where something
# for it is missing.
set -euo pipefail
program=$1 results=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

skip() {
  echo "skipped: $1; to install it, run bash tests/page/get_chromium.sh"
  exit 77
}
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || skip "there is no Chromium"
node=$(command -v node || command -v nodejs) || skip "there is no Node.js"
[ -f "$(dirname "$program")/../share/clerestory/page/viewer.js" ] || skip "three.js was not there to build with"

rm -rf "$results" && mkdir -p "$results"
for scene in office cornell_box; do  # daylight in grey, a lamp in colour
  "$program" solve "$here/../../data/scenes/$scene.json" -o "$results/$scene.vtp" --accuracy draft --quiet
  "$program" report "$results/$scene.vtp" -o "$results/$scene.html" --quiet
  "$node" "$here/open_page.mjs" "$chromium" "$results/$scene.html" "$results/$scene.vtp" "$results/$scene.png"
done
