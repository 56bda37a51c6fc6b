#!/usr/bin/env bash
# The tests under sanitizers: all for addresses and undefined behaviour (preset asan), then those of solver, pipeline and
# laws for races (preset tsan).
#   --quick   what CI runs: readers, and the fuzz targets with a solve by each method; transport in the solver for races
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# preset, then folders under tests/, all of whose tests are built and run; none: every test there is
under() {
  local preset=$1 folder
  shift
  cmake --preset "$preset" -DCLERESTORY_BUILD_TESTS=ON >/dev/null
  if [ $# -eq 0 ]; then
    cmake --build --preset "$preset"
    ctest --preset "$preset" --parallel "$(nproc)" --no-label-summary
    return
  fi
  cmake --build --preset "$preset" --target "${@/%//all}"
  for folder in "$@"; do
    ctest --test-dir "build/$preset/$folder" --output-on-failure --parallel "$(nproc)" --no-label-summary
  done
}

bash apps/install_dependencies.sh libgtest-dev
if [ "${1:-}" = --quick ]; then
  under asan tests/io tests/fuzz
  cmake --preset tsan -DCLERESTORY_BUILD_TESTS=ON >/dev/null
  cmake --build --preset tsan --target transport_test
  build/tsan/bin/transport_test --gtest_brief=1
else
  under asan
  under tsan tests/solver tests/pipeline tests/laws
fi
