#!/usr/bin/env bash
# Fuzzes the readers of files, all at the same time, for so many seconds: needs Clang, which apps/setup.sh all installs.
#   bash tests/fuzz/run.sh SECONDS [vdb|exr|png|json|fvx|transfer|vti|zarr|tiff|text]...     3600 for an hour each
# The tests replay the seeds with a hundred mutations each, without Clang and without sanitizers.
# What was found is kept in build-fuzz/corpus and begins the next run; a file that fails is in build-fuzz/failures.
set -euo pipefail
seconds="${1:?say for how many seconds}"
shift
kinds=("$@")
[ $# -gt 0 ] || kinds=(vdb exr png json fvx transfer vti zarr tiff text)
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
build="$here/../../build-fuzz"

# Optimising takes as long as a short run gains by it.
[ "$seconds" -lt 600 ] && optimisation=-O0 || optimisation=-O1
cmake -S "$here" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DREADERS_OPTIMISATION="$optimisation" >/dev/null
cmake --build "$build"
mkdir -p "$build/failures"
"$build/seeds" "$build/seeds-made"

declare -A runs
trap 'kill "${runs[@]}" 2>/dev/null || true' EXIT  # if this script is interrupted
for kind in "${kinds[@]}"; do
  mkdir -p "$build/corpus/$kind"
  echo "fuzz: $kind for $seconds s"
  "$build/${kind}_fuzz" -max_total_time="$seconds" -max_len=131072 -timeout=60 -rss_limit_mb=4096 -print_final_stats=1 \
    -artifact_prefix="$build/failures/$kind-" "$build/corpus/$kind" "$build/seeds-made/$kind" >"$build/$kind.log" 2>&1 &
  runs[$kind]=$!
done
failed=0
for kind in "${kinds[@]}"; do
  status=0
  wait "${runs[$kind]}" || status=$?
  echo "fuzz: $kind"
  grep -E "^stat::|ERROR|SUMMARY|runtime error|DONE|Test unit" "$build/$kind.log" || true
  [ "$status" -eq 0 ] || { failed=1; echo "fuzz: $kind FAILED, see $build/$kind.log and $build/failures"; }
done
[ "$failed" -eq 0 ] || exit 1
echo "fuzz: PASSED"
