#!/usr/bin/env bash
# Installs what building Clerestory needs, from the packages of Debian 12 (or a later relative), and the packages that are
# named as arguments: libgtest-dev for the tests.
# Packages that are there already are left alone; with all of them there, neither root nor a network is needed.
# Then by npm web-ifc, which reads IFC, and three.js with esbuild, which the 3D view of reports is bundled of. Without Node.js or
# npm's registry all else is built; .ifc is refused then, and reports have no 3D view.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/install_functions.sh"

packages=(
  g++ cmake ninja-build
  libembree-dev libtbb-dev                # rays, threads
  libcgal-dev                             # meshing
  libopenmesh-dev                         # elements, lightmaps
  coinor-libclp-dev                       # linear programmes: lamps dimmed to a target
  libstb-dev                              # places in a texture
  libassimp-dev nlohmann-json3-dev        # models and scene files in
  libvtk9-dev                             # results out
  libhdf5-dev                             # hours of a year out
  libopenimageio-dev                      # sky images and textures in
  libcli11-dev                            # the command line
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done

# What reads IFC. Node.js runs it; that may be there without being Debian's, and npm may come with it.
install_web_ifc() {
  command -v node >/dev/null || command -v nodejs >/dev/null || install_packages nodejs || return 1
  npm_install web-ifc --omit=dev
}

[ ${#missing[@]} -eq 0 ] || install_packages "${missing[@]}"
cd "$(dirname "${BASH_SOURCE[0]}")/../io/formats/ifc"
install_web_ifc || echo "web-ifc or Node.js could not be installed: IFC files will be refused, all else works." >&2
cd ../../page
npm_install three || echo "three.js could not be installed: reports will have no 3D view, all else works." >&2
echo "Dependencies: done."
