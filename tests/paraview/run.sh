#!/usr/bin/env bash
# Solves shipped scenes, and opens the results in Debian's ParaView: run.sh PROGRAM FOLDER
set -euo pipefail
program=$1 results=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$here/../../build/paraview/root

rm -rf "$results" && mkdir -p "$results"
for scene in furnace cornell_box office; do
  "$program" solve "$here/../../data/scenes/$scene.json" -o "$results/$scene.vtp" --report "$results/$scene.json" \
    --accuracy draft --quiet
done

# Xvfb chooses a free screen and tells its number when it is ready.
exec 3< <(exec Xvfb -displayfd 1 -noreset -nolisten tcp 2>"$results/xvfb.log")
screen=$!
trap 'kill $screen' EXIT
read -r -u 3 number || { cat "$results/xvfb.log" >&2; exit 1; }

DISPLAY=:$number PYTHONPATH=$root/usr/lib/python3/dist-packages \
  LD_LIBRARY_PATH=$root/lib/$(uname -m)-linux-gnu:$root/usr/lib/$(uname -m)-linux-gnu \
  "$root/usr/bin/pvpython" --force-offscreen-rendering "$here/open_results.py" "$results"
