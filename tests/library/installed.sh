#!/usr/bin/env bash
# Installs the library into a scratch folder, builds apps/examples/minimal against it and nothing else, and compares an image
# with that of the command line.
#   bash tests/library/installed.sh BUILD_FOLDER
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$(cd "$1" && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --component library --prefix "$scratch/installed"
cp -r "$root/apps/examples/minimal" "$scratch/source" # away from the project's own headers
cmake -S "$scratch/source" -B "$scratch/build" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/installed"
cmake --build "$scratch/build"
cd "$scratch"
"$scratch/build/minimal"
"$build/bin/freevoxels" render procedural:cloud expected.png --size 640x480 --fov 30 --orbit 120,20
cmp view_120.png expected.png
