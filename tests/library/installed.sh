#!/usr/bin/env bash
# Installs the library into a scratch folder, builds apps/examples/minimal and apps/examples/interop against it and nothing else,
# and compares their images with that of the command line.
#   bash tests/library/installed.sh BUILD_FOLDER
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$(cd "$1" && pwd)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --component library --prefix "$scratch/installed"
# The macros of the headers alone say which version they are.
printf '#include <freevoxels/version.h>\nFREEVOXELS_VERSION_MAJOR . FREEVOXELS_VERSION_MINOR . FREEVOXELS_VERSION_PATCH\n' |
  c++ -E -P -x c++ -I "$scratch/installed/include" - | tr -d ' ' >"$scratch/header_version.txt"
"$build/bin/freevoxels" --version | grep -F "$(cat "$scratch/header_version.txt")"
for example in minimal interop; do
  cp -r "$root/apps/examples/$example" "$scratch/$example" # away from the project's own headers
  cmake -S "$scratch/$example" -B "$scratch/$example/build" -G Ninja -DCMAKE_PREFIX_PATH="$scratch/installed"
  cmake --build "$scratch/$example/build"
done
cd "$scratch"
minimal/build/minimal
# The example's own instance has no validation layers, so the loader adds them, which then write to standard output.
VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation \
  VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT interop/build/interop | tee interop.txt
if grep -E 'Validation (Error|Warning)|VUID-|SYNC-HAZARD' interop.txt; then exit 1; fi
"$build/bin/freevoxels" render procedural:cloud expected.png --size 640x480 --fov 30 --orbit 120,20
cmp view_120.png expected.png
cmp interop_120.png expected.png
cmp interop_240.png view_240.png
