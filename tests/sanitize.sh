#!/usr/bin/env bash
# Builds with sanitizers and runs what they are for. Takes an hour the first time on two cores.
#   bash tests/sanitize.sh address                      address and undefined behaviour: the tests of the CPU and of the programs
#   bash tests/sanitize.sh thread                       threads that read volumes and images, with Clang (apt-get install clang), and those of
#                                                       the viewer and of pipelines
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"
case "${1:?say address or thread}" in
  address)
    cmake --preset sanitize
    cmake --build --preset sanitize --target freevoxels_unit_tests freevoxels_command_tests
    build-sanitize/bin/freevoxels_unit_tests
    # LLVM, which draws on the CPU, keeps what it has allocated: leaks are looked for in the tests of the CPU alone. The sanitizer's own
    # memory is more than those of MemoryLimit allow.
    ASAN_OPTIONS=detect_leaks=0 build-sanitize/bin/freevoxels_command_tests --gtest_filter='-Viewer.*:MemoryLimit.*:RealVolumes.*'
    ;;
  thread)
    build="$root/build-threads"
    cmake -S tests/fuzz -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DREADERS_SANITIZER=thread >/dev/null
    cmake --build "$build"
    TSAN_OPTIONS=report_bugs=0 "$build/seeds" "$build/seeds-made"  # only writes the files
    export TSAN_OPTIONS="suppressions=$root/tests/fuzz/thread_suppressions.txt halt_on_error=1"
    "$build/threads" "$build/seeds-made"
    cmake --preset sanitize-threads
    cmake --build --preset sanitize-threads --target freevoxels_unit_tests freevoxels_device_tests
    # On one processor oneTBB, whose joins the sanitizer does not see, adds no threads to those of the project.
    taskset -c 0 build-sanitize-threads/bin/freevoxels_unit_tests \
      --gtest_filter='PipelineStore*:ExportJob*:SessionStore*:BackgroundWriter*'
    taskset -c 0 build-sanitize-threads/bin/freevoxels_device_tests --gtest_filter='RenderThread*:ImageDirector*:ImageMaker*'
    ;;
  *)
    echo "say address or thread"
    exit 2
    ;;
esac
