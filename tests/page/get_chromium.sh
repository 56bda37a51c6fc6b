#!/usr/bin/env bash
# Installs what the tests of pages in a browser need: Chromium, and Node.js, which speaks to it. Without them they are skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bash apps/install_dependencies.sh chromium nodejs
