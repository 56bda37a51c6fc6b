#!/usr/bin/env bash
# Runs a script in the Blender of get_blender.sh, without a screen: blender.sh SCRIPT ARGUMENTS...
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/build/blender/root
script=$1
shift
libraries=$root/usr/lib/$(uname -m)-linux-gnu
BLENDER_SYSTEM_SCRIPTS=$root/usr/share/blender/scripts BLENDER_SYSTEM_DATAFILES=$root/usr/share/blender/datafiles \
  PYTHONPATH=$root/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$root/usr/lib:$libraries:$libraries/blas:$libraries/lapack:$libraries/pulseaudio \
  "$root/usr/bin/blender" --background --factory-startup --python-exit-code 1 --python "$script" -- "$@"
