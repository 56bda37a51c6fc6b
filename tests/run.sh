#!/usr/bin/env bash
# Installs what is missing, builds everything, and runs all tests. Ends with CTest's summary.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash apps/install_dependencies.sh
cmake --preset release -DCLERESTORY_BUILD_TESTS=ON
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
