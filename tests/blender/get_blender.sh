#!/usr/bin/env bash
# Gets Debian's Blender into build/blender, once: beside the system and not into it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. tests/support/get_beside.sh
get_beside "$PWD/build/blender" 100 blender python3-numpy
echo "Blender: there."
