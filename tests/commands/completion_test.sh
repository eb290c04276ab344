#!/usr/bin/env bash
# The completion for bash, against the program's own help.
#   bash tests/commands/completion_test.sh FREEVOXELS_PROGRAM
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../apps/freevoxels/completion.bash"
program=$1
failures=0

expect() { # EXPECTED WORD..., of which the last is incomplete
  local expected=$1
  shift
  COMP_WORDS=(freevoxels "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _freevoxels "$program" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
  if [ "${COMPREPLY[*]}" != "$expected" ]; then
    echo "after 'freevoxels $*' expected '$expected', got '${COMPREPLY[*]}'"
    failures=$((failures + 1))
  fi
}

expect "render turntable merge oracle compare info convert generate bake presets convert-tf devices" ""
expect "turntable" tu
expect "--density-scale" render cloud.vdb --dens
expect "--culling --cull-threshold" render cloud.vdb --cull
expect "gather splats" render cloud.vdb --draw ""
expect "scatter" render cloud.vdb --shading s
expect "--json" compare a.exr b.exr --j
expect "completion_test.sh" render "completion_te"
exit "$failures"
