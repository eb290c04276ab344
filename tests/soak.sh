#!/usr/bin/env bash
# Draws many frames and many volumes in one process each, and checks that memory and open files stay flat. Takes minutes.
#   bash tests/soak.sh [FRAMES [VOLUMES]]     1000 frames of a turntable, 200 volumes of a sequence
# build/bin/freevoxels must be there, or FREEVOXELS_PROGRAM name another.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
program="${FREEVOXELS_PROGRAM:-$root/build/bin/freevoxels}"
frames="${1:-1000}"
volumes="${2:-200}"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
failed=0

# soak NAME COMMAND...: runs it and samples resident KiB and open files of the process. The largest of the last quarter may be at most
# 2 % and 4 MiB above that of the second quarter (the first one fills caches); at most two files more, which are being
# read or written, may be open.
soak() {
  local name="$1" samples="$folder/samples" pid
  shift
  "$@" >"$folder/log" 2>&1 &
  pid=$!
  : >"$samples"
  while kill -0 "$pid" 2>/dev/null; do
    if memory=$(awk '/^VmRSS/ { print $2 }' "/proc/$pid/status" 2>/dev/null) && [ -n "$memory" ]; then
      echo "$memory $(find "/proc/$pid/fd" -mindepth 1 2>/dev/null | wc -l)" >>"$samples"
    fi
    sleep 0.2
  done
  wait "$pid" || { cat "$folder/log" >&2; echo "soak: $name FAILED"; exit 1; }
  awk -v name="$name" '
    { memory[NR] = $1; files[NR] = $2 }
    function most(values, from, to,   i, result) { for (i = from; i <= to; ++i) if (values[i] > result) result = values[i]; return result }
    END {
      if (NR < 20) { print "soak: " name " took too few samples: give more frames or volumes"; exit 2 }
      quarter = int(NR / 4)
      before = most(memory, quarter, 2 * quarter); after = most(memory, 3 * quarter, NR - 1)
      filesBefore = most(files, quarter, 2 * quarter); filesAfter = most(files, 3 * quarter, NR - 1)
      printf "soak: %s: %d MiB and %d files, at the end %d MiB and %d files\n", name, before / 1024, filesBefore, after / 1024, filesAfter
      if (after > 1.02 * before + 4096 || filesAfter > filesBefore + 2) { print "soak: " name " FAILED: not flat"; exit 1 }
    }' "$samples" || failed=1
}

soak "$frames frames" "$program" turntable procedural:cloud "$folder/frame_#####.png" --resolution 32 --size 64 --frames "$frames" --quiet

for kind in 0 1 2 3; do "$program" generate cloud "$folder/made_$kind.vdb" --resolution $((28 + 4 * kind)) --quiet; done
for i in $(seq 1 "$volumes"); do cp "$folder/made_$((i % 4)).vdb" "$folder/volume_$(printf %05d "$i").vdb"; done
soak "$volumes volumes" "$program" render "$folder/volume_#####.vdb" "$folder/volume_#####.png" --size 64 --quiet
[ "$failed" -eq 0 ] || exit 1
echo "soak: PASSED"
