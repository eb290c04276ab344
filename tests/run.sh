#!/usr/bin/env bash
# Sets up as apps/setup.sh does, builds everything and runs all the tests. Works from any folder.
#   bash tests/run.sh [CTEST OPTIONS...]     for instance -R Camera
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

bash "$root/apps/setup.sh" all
cd "$root"
log=build/tests.log
status=0
# One more than there are processors: tests of windows and of other processes wait most of the time.
ctest --preset release --no-tests=error --parallel $(($(nproc) + 1)) "$@" 2>&1 | tee "$log" || status=$?

summary="$(grep -E '^[0-9]+% tests passed' "$log" || echo 'the tests did not run')"
skipped="$(grep -c -E '\*\*\*Skipped' "$log" || true)"
if [ "$status" -eq 0 ]; then
  echo "tests: PASSED, $summary, $skipped skipped"
else
  echo "tests: FAILED, $summary, $skipped skipped; the log is $root/$log"
fi
exit "$status"
