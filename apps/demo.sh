#!/usr/bin/env bash
# From nothing to an image: sets up, builds, and draws a volume into out/.
#   bash apps/demo.sh                                   a procedural cloud, written to out/cloud.vdb first
#   bash apps/demo.sh FILE.vdb [RENDER OPTIONS...]      your volume; options as in `freevoxels render --help`
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
freevoxels="$root/build/bin/freevoxels"
out="$root/out"

bash "$root/apps/setup.sh" freevoxels
mkdir -p "$out"

if [ $# -eq 0 ]; then
  echo "demo: making a cloud"
  "$freevoxels" generate cloud "$out/cloud.vdb" --resolution 192
  input="$out/cloud.vdb"
  set -- --scene "$root/apps/scenes/cloud.json"
else
  input="$1"
  shift
fi

name="$(basename "${input#procedural:}")"
name="${name%.*}"
echo "demo: drawing $input"
"$freevoxels" render "$input" "$out/$name.exr" "$out/$name.png" "$@"
echo "demo: the images are the files above"
