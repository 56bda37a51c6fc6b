#!/usr/bin/env bash
# Solves shipped scenes, makes their pages and holds these against the results: run.sh PROGRAM FOLDER SCRIPT, which is
# read_solution.mjs, or open_page.mjs in Chromium. Ends with 77 where something for it is missing.
set -euo pipefail
program=$1 results=$2 script=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

skip() {
  echo "skipped: $1; to install it, run bash $2"
  exit 77
}
browser=()
node=$(command -v node || command -v nodejs) || skip "there is no Node.js" apps/install_dependencies.sh
[ -f "$(dirname "$program")/../share/clerestory/page/viewer.js" ] ||
  skip "three.js was not there to build with" "apps/install_dependencies.sh and build again"
if [ "$script" = open_page.mjs ]; then
  chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
    skip "there is no Chromium" tests/page/get_chromium.sh
  browser=("$chromium" "$results")
fi

rm -rf "$results" && mkdir -p "$results"
for scene in office cornell_box classroom; do  # daylight in grey, a glowing lamp in colour, luminaires in layers
  layers=()
  [ $scene = office ] || layers=(--layers)
  "$program" solve "$here/../../data/scenes/$scene.json" -o "$results/$scene.vtp" --accuracy draft --no-error --quiet "${layers[@]}"
  "$program" report "$results/$scene.vtp" -o "$results/$scene.html" --quiet
  "$node" "$here/$script" "$results/$scene.html" "$results/$scene.vtp" "${browser[@]}"
done
