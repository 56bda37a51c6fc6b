# Debian's packages beside the system and not into it, for scripts that source this.

# get_beside FOLDER MEGABYTES PACKAGES...: unpacks them into FOLDER/root, once, with the libraries that are not there yet, and
# today's updates of those that are, which apt-get chooses as if it installed them.
get_beside() {
  local here=$1 package as_root=()
  [ ! -d "$here/root" ] || return 0
  echo "Downloading some $2 MB to $here"
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  rm -rf "$here" && mkdir -p "$here/packages/partial"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" apt-get install -y -qq --no-install-recommends --download-only \
    -o Dir::Cache::archives="$here/packages" -o APT::Sandbox::User=root "${@:3}" >/dev/null
  for package in "$here"/packages/*.deb; do dpkg -x "$package" "$here/unfinished"; done
  mv "$here/unfinished" "$here/root"
}
