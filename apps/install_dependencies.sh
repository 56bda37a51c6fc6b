#!/usr/bin/env bash
# Installs what building Clerestory needs, from the packages of Debian 12 (or a later relative), and the packages that are
# named as arguments: libgtest-dev for the tests.
# Packages that are there already are left alone; with all of them there, neither root nor a network is needed.
# Then web-ifc, which reads IFC, by npm. Without Node.js or npm's registry all else is built, and .ifc is refused.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libembree-dev libtbb-dev                # rays, threads
  libcgal-dev                             # meshing
  libopenmesh-dev                         # elements, lightmaps
  libstb-dev                              # places in a texture
  libassimp-dev nlohmann-json3-dev        # models and scene files in
  libvtk9-dev                             # results out
  libopenimageio-dev                      # sky images and textures in
  libcli11-dev                            # the command line
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done

# Installs its arguments; says why not.
install_packages() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These packages are missing: $*" >&2
      echo "Install them as root (apt-get install), or run this script as root or with sudo installed." >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Dependencies: installing $*"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null || {
    echo "Installing failed. If Debian's own python3-paraview is there: it excludes libvtk9-dev." >&2
    echo "Remove it (apt-get remove python3-paraview), or take ParaView from its makers instead." >&2
    return 1
  }
}

# The version of web-ifc that package-lock.json pins, by npm, without scripts of its own.
install_web_ifc() {
  local wanted found tools=()
  wanted=$(sed -n 's/.*"web-ifc": "\(.*\)".*/\1/p' package.json)
  found=$(sed -n 's/^  "version": "\(.*\)".*/\1/p' node_modules/web-ifc/package.json 2>/dev/null)
  # Node.js may be there without being Debian's, and npm may come with it.
  command -v node >/dev/null || command -v nodejs >/dev/null || tools+=(nodejs)
  [ "$wanted" = "$found" ] || command -v npm >/dev/null || tools+=(npm)
  [ ${#tools[@]} -eq 0 ] || install_packages "${tools[@]}" || return 1
  [ "$wanted" = "$found" ] && return 0
  echo "Dependencies: installing web-ifc $wanted"
  npm ci --omit=dev --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null
}

[ ${#missing[@]} -eq 0 ] || install_packages "${missing[@]}"
cd "$(dirname "${BASH_SOURCE[0]}")/../io/formats/ifc"
install_web_ifc || echo "web-ifc or Node.js could not be installed: IFC files will be refused, all else works." >&2
echo "Dependencies: done."
