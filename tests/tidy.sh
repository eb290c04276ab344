#!/usr/bin/env bash
# Runs clang-tidy with the rules of .clang-tidy. Needs the package clang-tidy and a configured build folder.
#   bash tests/tidy.sh [FILE.cpp...]     default: the files that differ from the last commit
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ $# -gt 0 ] || mapfile -t files < <(git diff --name-only --diff-filter=d HEAD -- '*.cpp')
[ $# -eq 0 ] || files=("$@")
[ ${#files[@]} -gt 0 ] || { echo "tidy: no .cpp file differs from the last commit"; exit 0; }

# Clang cannot read GCC's precompiled headers: the same commands without them.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
sed -E 's/-Winvalid-pch -include [^ ]+//' build/compile_commands.json > "$scratch/compile_commands.json"
clang-tidy -p "$scratch" --quiet "${files[@]}"
