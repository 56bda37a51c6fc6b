#!/usr/bin/env bash
# Bakes shipped scenes, and reads them in Debian's Blender: run.sh PROGRAM FOLDER
set -euo pipefail
program=$1 results=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

rm -rf "$results" && mkdir -p "$results"
for scene in cornell_box office; do
  "$program" solve "$here/../../data/scenes/$scene.json" -o "$results/$scene.vtp" --accuracy draft --no-error --quiet
  for detail in light model; do
    for extension in glb ply; do
      "$program" bake "$results/$scene.vtp" -o "$results/${scene}_$detail.$extension" --detail "$detail" --quiet
    done
  done
done
bash "$here/blender.sh" "$here/read_baked.py" "$results"
