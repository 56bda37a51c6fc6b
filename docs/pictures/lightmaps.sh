#!/usr/bin/env bash
# Draws lightmaps.png in the Blender of tests/blender/get_blender.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=build/release/bin/clerestory
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bash tests/blender/get_blender.sh
"$program" solve data/scenes/cornell_box.json -o "$work/box.vtp" --no-error --quiet
for detail in light model; do "$program" bake "$work/box.vtp" -o "$work/$detail.glb" --detail "$detail" --quiet; done
bash tests/blender/blender.sh docs/pictures/lightmaps.py "$work/light.glb" "$work/model.glb" "$work/lightmaps.png"
mv "$work/lightmaps.png" docs/pictures/lightmaps.png
