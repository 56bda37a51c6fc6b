#!/usr/bin/env bash
# Runs a script in the ParaView of get_paraview.sh, on a screen of its own: pvpython.sh SCRIPT ARGUMENTS...
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/build/paraview/root
log=$(mktemp)

# Xvfb chooses a free screen and tells its number when it is ready.
exec 3< <(exec Xvfb -displayfd 1 -noreset -nolisten tcp 2>"$log")
screen=$!
trap 'kill $screen; rm -f "$log"' EXIT
read -r -u 3 number || { cat "$log" >&2; exit 1; }

DISPLAY=:$number PYTHONPATH=$root/usr/lib/python3/dist-packages \
  LD_LIBRARY_PATH=$root/lib/$(uname -m)-linux-gnu:$root/usr/lib/$(uname -m)-linux-gnu \
  "$root/usr/bin/pvpython" --force-offscreen-rendering "$@"
