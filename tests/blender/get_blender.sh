#!/usr/bin/env bash
# Gets Debian's Blender into build/blender, once: beside the system and not into it, with the libraries that are not
# there yet, which apt-get chooses as if it were installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

here=$PWD/build/blender
if [ ! -d "$here/root" ]; then
  echo "Blender: downloading some 100 MB to build/blender"
  as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  rm -rf "$here" && mkdir -p "$here/packages/partial"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" apt-get install -y -qq --no-install-recommends --download-only \
    -o Dir::Cache::archives="$here/packages" -o APT::Sandbox::User=root blender python3-numpy >/dev/null
  for package in "$here"/packages/*.deb; do dpkg -x "$package" "$here/unfinished"; done
  mv "$here/unfinished" "$here/root"
fi
echo "Blender: there."
