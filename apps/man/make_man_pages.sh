#!/usr/bin/env bash
# Writes a man page for each program and for each of its commands, from --help.
#   bash apps/man/make_man_pages.sh VERSION OUT_FOLDER PROGRAM...
# Pages: PROGRAM.1, and PROGRAM-COMMAND.1 for programs with commands. Needs help2man.
set -euo pipefail
version=$1 out=$2
shift 2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# What help2man expects of --help: spaces between the names of an option, no marks of CLI11, and a prompt before examples.
tidy() {
  sed -E -e 's/^(  -[^ ]*)\{false\}/\1/' -e 's/^(  [^ ]+) +\.\.\.  /\1...  /' -e 's/^(  --?[^ ,]*),--/\1, --/' \
    -e 's/^(  -.*[^ ]) (Excludes|Needs):( --[a-z-]+)+/\1/' \
    -e 's/^Positionals:/Arguments:/' -e '/^Examples:/,$ s/^  /  $ /'
}

page() { # NAME PROGRAM [COMMAND]
  local name=$1 summary
  shift
  "$@" --help | tidy > "$scratch/help"
  summary=$(head -n 1 "$scratch/help")
  summary=${summary%.}
  printf '#!/bin/sh\ncat "%s"\n' "$scratch/help" > "$scratch/$name"
  chmod +x "$scratch/$name"
  help2man --no-info --section 1 --manual "FreeVoxels" --source "FreeVoxels $version" --version-string "$version" \
    --name "${summary,}" --include "$scratch/sections" --output "$out/$name.1" "$scratch/$name"
}

cat > "$scratch/sections" <<'SECTIONS'
[EXIT STATUS]
0 done, 1 internal error, 2 usage, 3 input, 4 output, 5 device, 6 out of memory, 7 images differ or a check failed

[ENVIRONMENT]
.TP
FREEVOXELS_VALIDATION
1 turns the Vulkan validation layers on; any message of theirs is an error.

[SEE ALSO]
.BR freevoxels (1),
.BR freevoxels-view (1),
.BR freevoxels-bench (1),
.BR freevoxels-validate (1),
.BR freevoxels-mpi (1),
and /usr/share/doc/freevoxels/apps/manual
SECTIONS

mkdir -p "$out"
rm -f "$out"/*.1
for program in "$@"; do
  name=$(basename "$program")
  page "$name" "$program"
  for command in $("$program" --help | sed -n '/^Subcommands:/,/^ *$/s/^  \([a-z][a-z-]*\) .*/\1/p'); do
    page "$name-$command" "$program" "$command"
  done
done
