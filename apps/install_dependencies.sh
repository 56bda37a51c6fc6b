#!/usr/bin/env bash
# Installs what building Clerestory needs, from the packages of Debian 12 (or a later relative), and the packages that are
# named as arguments: libgtest-dev for the tests.
# Packages that are there already are left alone; with all of them there, neither root nor a network is needed.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libembree-dev libtbb-dev                # rays, threads
  libcgal-dev                             # meshing
  libopenmesh-dev                         # elements, lightmaps
  libassimp-dev nlohmann-json3-dev        # models and scene files in
  libvtk9-dev                             # results out
  libopenimageio-dev                      # sky images in
  libcli11-dev                            # the command line
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "Dependencies: all installed."
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing: ${missing[*]}" >&2
    echo "Install them as root (apt-get install), or run this script as root or with sudo installed." >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Dependencies: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null; then
  echo "Installing failed. If Debian's own python3-paraview is there: it excludes libvtk9-dev." >&2
  echo "Remove it (apt-get remove python3-paraview), or take ParaView from its makers instead." >&2
  exit 1
fi
echo "Dependencies: done."
