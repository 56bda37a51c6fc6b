#!/usr/bin/env bash
# Installs gltf-validator, the version that package-lock.json pins. three.js is that of pages, which
# apps/install_dependencies.sh installs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. ../../apps/install_functions.sh
npm_install gltf-validator
