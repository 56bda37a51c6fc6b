#!/usr/bin/env bash
# The tests under sanitizers: all for addresses and undefined behaviour (preset asan), then those of solver, pipeline and
# laws for races (preset tsan).
#   --quick   what CI runs: readers, the fuzz targets and with them a solve by each method; for races glass and mirrors, which are whole solves
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# preset, then what to build; nothing: all
build() {
  cmake --preset "$1" -DCLERESTORY_BUILD_TESTS=ON >/dev/null
  cmake --build --preset "$1" ${2:+--target "${@:2}"}
}
in_parallel=(--parallel "$(nproc)" --output-on-failure --no-label-summary)

bash apps/install_dependencies.sh libgtest-dev
if [ "${1:-}" = --quick ]; then
  # What compiles fast of what reads strangers' files: the program itself is left out, its command line takes long.
  readers=(io_read_test photometry_test io_sky_test io_image_test)
  build asan "${readers[@]}" \
    fuzz_{scene,obj,mtl,ply,stl,off,gltf,glb,dae,fbx,ifc,ifc_answer,epw,ies,ldt,sensors,json,text,model_bytes,meshing,solve}
  for program in "${readers[@]}"; do build/asan/bin/"$program" --gtest_brief=1; done
  ctest --preset asan --tests-regex '^Fuzz\.' --exclude-regex arguments "${in_parallel[@]}"
  build tsan glass_test mirror_test
  for program in glass_test mirror_test; do build/tsan/bin/$program --gtest_brief=1; done
else
  build asan
  ctest --preset asan "${in_parallel[@]}"
  build tsan tests/{solver,pipeline,laws}/all
  for folder in solver pipeline laws; do ctest --test-dir build/tsan/tests/$folder "${in_parallel[@]}"; done
fi
