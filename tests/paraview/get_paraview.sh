#!/usr/bin/env bash
# Gets Debian's ParaView into build/paraview, once: beside the system and not into it, because python3-paraview excludes
# libvtk9-dev, which the build needs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

bash apps/install_dependencies.sh xvfb  # the screen that Debian's ParaView wants even when it draws none
. tests/support/get_beside.sh
here=$PWD/build/paraview
get_beside "$here" 120 paraview python3-paraview libexpat1

# With the expat of before, ParaView opened files that it refuses with today's.
expat=$(dpkg-deb --field "$here"/packages/libexpat1_*.deb Version 2>/dev/null ||
  dpkg-query --show --showformat='${Version}' libexpat1)
if dpkg --compare-versions "$expat" lt 2.5.0-1+deb12u2; then
  echo "ParaView: libexpat1 $expat is not the updated one (2.5.0-1+deb12u2 and later), so the test would prove nothing." >&2
  echo "Add Debian's security updates to the sources of apt-get, remove build/paraview and try again." >&2
  exit 1
fi
echo "ParaView: there, with libexpat1 $expat."
