#!/usr/bin/env bash
# Links of the installed README and manual lead to what is installed with them.
#   bash tests/documentation/installed_pages_test.sh BUILD_FOLDER
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
cmake --install "$1" --prefix "$scratch" >"$scratch/log" || { tail "$scratch/log"; exit 1; }
python3 "$here/check_documentation.py" --links "$scratch/share/doc/freevoxels"
