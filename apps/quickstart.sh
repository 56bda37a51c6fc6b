#!/usr/bin/env bash
# From a bare Debian 12 to a first result: installs, builds, solves a scene, says how to look at it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

echo "== 1 of 3: what the build needs"
bash apps/install_dependencies.sh

echo "== 2 of 3: building the program"
cmake --preset release -DCLERESTORY_BUILD_TESTS=OFF
cmake --build --preset release

echo "== 3 of 3: solving a daylit office, and what one takes home from it"
program=build/release/bin/clerestory
"$program" solve data/scenes/office.json -o build/office.vtp --report build/office.json
"$program" render build/office.vtp -o build/office.png --show illuminance --log-scale --isolux 100,200,300,500
"$program" report build/office.vtp -o build/office.html --target 300

cat <<END

build/office.png is a picture of the room in false colours of illuminance, with isolux lines: open it in any viewer.
build/office.html is a page for whoever asked: figures, plans, and a 3D view to turn and to click. Open it in
a browser; it needs no network.

The result itself is build/office.vtp. To look at it: open it in ParaView, press Apply, and colour by
"illuminance" or "daylight_factor". "Backface Representation: Cull Backface" in the properties
lets you look into the room from outside. The illuminance at desk height is in
build/office.sensors.csv, the figures of the run are in build/office.json.

Next:  $program bake build/office.vtp -o build/office.glb        a lightmap for three.js, Blender and others
       $program solve data/scenes/house.json -o build/house.vtp
       $program --help
END
