#!/usr/bin/env bash
# Installs what reads baked files as others do: gltf-validator and three.js, the versions that package-lock.json pins, by
# npm, without scripts of their own. Node.js and npm are those of apps/install_dependencies.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
for package in gltf-validator three; do
  wanted=$(sed -n "s/.*\"$package\": \"\([^\"]*\)\".*/\1/p" package.json)
  found=$(sed -n 's/^  "version": "\(.*\)".*/\1/p' "node_modules/$package/package.json" 2>/dev/null) || true
  [ "$wanted" = "$found" ] || missing=1
done
[ -n "${missing:-}" ] || exit 0
command -v npm >/dev/null || { echo "npm is missing: apt-get install npm" >&2; exit 1; }
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >/dev/null
