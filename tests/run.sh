#!/usr/bin/env bash
# Installs what is missing, builds everything, and runs the tests. Ends with CTest's summary.
#   --quick     without those that are labelled long
#   --paraview  also opens results in Debian's ParaView, which it downloads once
#   --blender   the same with baked files and Debian's Blender
# Whatever else there is goes to ctest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

to_ctest=()
for argument in "$@"; do
  case $argument in
    --quick) to_ctest+=(--label-exclude long) ;;
    --paraview)
      to_ctest+=(--build-config paraview)
      bash tests/paraview/get_paraview.sh
      ;;
    --blender)
      to_ctest+=(--build-config blender)
      bash tests/blender/get_blender.sh
      ;;
    *) to_ctest+=("$argument") ;;
  esac
done

bash apps/install_dependencies.sh libgtest-dev
bash tests/gltf/install.sh || echo "gltf-validator could not be installed: its test is skipped." >&2
cmake --preset release -DCLERESTORY_BUILD_TESTS=ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" --no-label-summary "${to_ctest[@]}"
