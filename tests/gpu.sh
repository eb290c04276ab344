#!/usr/bin/env bash
# All that a GPU is needed for, in about eight minutes: the device tests with Vulkan's validation layers, freevoxels-validate, the same image
# five times, and the figures of engine/docs/performance.md. Build before (apps/setup.sh all). Works from any folder.
#   bash tests/gpu.sh [--any-device] [OUT]     logs and bench.json are written to OUT [build/gpu]; --any-device goes on without a GPU
# Then: python3 apps/bench/performance_table.py engine/docs/performance.md build/gpu/bench.json
set -uo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
bin="$root/build/bin"
any=no
if [ "${1:-}" = --any-device ]; then any=yes; shift; fi
out="${1:-$root/build/gpu}"
mkdir -p "$out" || exit 1
failed=()

if [ ! -x "$bin/freevoxels" ]; then echo "gpu: there are no programs in $bin; run apps/setup.sh all" >&2; exit 1; fi
"$bin/freevoxels" devices
if [ "$any" = no ] && ! "$bin/freevoxels" devices --json | grep -E '"type": "(discrete|integrated|virtual) GPU"' > /dev/null; then
  echo "gpu: this machine has no GPU that can be used; --any-device goes on without" >&2
  exit 1
fi

echo "== the same image five times ($(date +%T))"
view=(--orbit 30,20 --size 1024 --float --quiet)
while read -r name arguments; do
  # shellcheck disable=SC2086
  kinds="$(for _ in 1 2 3 4 5; do
    rm -f "$out/bits.exr"
    "$bin/freevoxels" render $arguments "$out/bits.exr" "${view[@]}" > /dev/null && sha256sum < "$out/bits.exr" || echo failed
  done | sort -u)"
  if [ "$(wc -l <<< "$kinds")" -eq 1 ] && [ "$kinds" != failed ]; then
    echo "$name: the same bits"
  else
    echo "$name: FAILED, other bits"
    failed+=("bits of $name")
  fi
done <<'SCENES'
cloud procedural:cloud --resolution 256
head procedural:head --resolution 256 --transfer-function skin-and-bone
fire procedural:fire --resolution 256
splats procedural:cloud --resolution 128 --paper
SCENES
rm -f "$out/bits.exr"

echo "== device tests with validation layers ($(date +%T))"
shards="$(nproc)"
if [ "$shards" -gt 12 ]; then shards=12; fi
for ((i = 0; i < shards; ++i)); do
  GTEST_TOTAL_SHARDS="$shards" GTEST_SHARD_INDEX="$i" "$bin/freevoxels_device_tests" > "$out/tests_$i.log" 2>&1 &
done
wait
cat "$out"/tests_*.log > "$out/tests.log"
rm -f "$out"/tests_*.log
echo "passed: $(grep -c '^\[       OK' "$out/tests.log"), failed: $(grep '^\[  FAILED  \]' "$out/tests.log" | grep -c ' ms)')"
grep '^\[  FAILED  \]' "$out/tests.log" | grep ' ms)' && failed+=("device tests")
if [ "$(grep -c '^\[==========\].* ran\.' "$out/tests.log")" -ne "$shards" ]; then failed+=("device tests that ended early"); fi

echo "== freevoxels-validate --quick ($(date +%T))"
"$bin/freevoxels-validate" --quick > "$out/validate.log" 2>&1 || failed+=("freevoxels-validate")
tail -3 "$out/validate.log"

echo "== freevoxels-bench ($(date +%T))"
"$bin/freevoxels-bench" --json "$out/bench.json" > "$out/bench.log" 2>&1 || failed+=("freevoxels-bench")
cat "$out/bench.log"

if [ ${#failed[@]} -eq 0 ]; then
  echo "gpu: PASSED"
else
  printf 'gpu: FAILED: %s\n' "${failed[@]}"
  exit 1
fi
