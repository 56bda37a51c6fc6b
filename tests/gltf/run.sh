#!/usr/bin/env bash
# Bakes shipped scenes, and one with a model that a bake wrote, and reads all of it with gltf-validator and three.js:
# run.sh PROGRAM FOLDER. Ends with 77, which CTest takes as skipped, where those are not installed.
set -euo pipefail
program=$1 results=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

if ! command -v node >/dev/null || [ ! -d "$here/../../io/page/node_modules/three" ] ||
  [ ! -d "$here/node_modules/gltf-validator" ]; then
  echo "Not installed: three.js or gltf-validator; apps/install_dependencies.sh and tests/gltf/install.sh get them."
  exit 77
fi

rm -rf "$results" && mkdir -p "$results"
bake() {  # SCENE NAME
  local scene=$1 name=$2
  "$program" solve "$scene" -o "$results/$name.vtp" --accuracy draft --no-error --quiet
  for detail in light model; do
    for extension in glb ply; do
      "$program" bake "$results/$name.vtp" -o "$results/${name}_$detail.$extension" --detail "$detail" --quiet
    done
  done
}
bake "$here/../../data/scenes/cornell_box.json" box
bake "$here/../../data/scenes/office.json" office
# A scene of two models far from the origin, one of them turned and baked before.
cat > "$results/far.json" <<END
{ "geometry": [
    { "file": "office_model.glb", "transform": [0, -1, 0, 1000000, 1, 0, 0, 2000000, 0, 0, 1, 50, 0, 0, 0, 1] },
    { "file": "$(realpath "$here/../../data/scenes/cornell_box.obj")",
      "transform": [0.01, 0, 0, 1000020, 0, 0.01, 0, 2000000, 0, 0, 0.01, 50, 0, 0, 0, 1] } ],
  "sky": { "model": "cie-overcast", "horizontal_illuminance": 10000 } }
END
bake "$results/far.json" far

node "$here/read_baked.mjs" "$results"/*_light.glb "$results"/*_model.glb

# Light as a texture, as base colour and as MOZ_lightmap.
"$program" bake "$results/box.vtp" -o "$results/box atlas.glb" --texels-per-metre 200 --quiet
"$program" bake "$results/office.vtp" -o "$results/office_atlas.glb" --texels-per-metre 20 --quiet
"$program" bake "$results/office.vtp" -o "$results/office_extension_atlas.glb" --texels-per-metre 20 --lightmap-extension --quiet
node "$here/read_atlas.mjs" "$results"/*atlas.glb
