# Installing, for scripts that source this: install_packages and npm_install.

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

# npm_install NAME OPTIONS...: the version of NAME, and of what it needs, that package-lock.json of this folder pins, by npm,
# without scripts of their own.
npm_install() {
  local name=$1 wanted found
  wanted=$(sed -n 's/.*"'"$name"'": "\([^"]*\)".*/\1/p' package.json)
  found=$(sed -n '/^ *"version": /{s/.*: "\(.*\)".*/\1/p;q}' "node_modules/$name/package.json" 2>/dev/null) || true
  [ "$wanted" = "$found" ] && return 0
  command -v npm >/dev/null || install_packages npm || return 1
  echo "Dependencies: installing $name $wanted"
  npm ci "${@:2}" --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null
}
