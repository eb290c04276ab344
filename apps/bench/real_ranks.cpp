#include "apps/bench/real_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>

namespace freevoxels::bench {

namespace {

/// Frames of the longer of two runs, whose difference to a run of one frame is that of frames alone.
constexpr int kFrames = 5;

std::filesystem::path programBeside(const char* name) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
}

/// Runs of a job, of which the least time counts.
constexpr int kRuns = 2;

/// Wall time of a job, which writes into `folder`.
std::optional<double> millisecondsOfRun(int ranks, int frames, const std::string& volume, int resolution, const std::string& folder) {
  const std::string command = fmt::format(
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 LP_NUM_THREADS=1 mpirun --map-by :OVERSUBSCRIBE --bind-to none -n {} '{}' turntable procedural:{} '{}/frame_#.png' --frames {} "
      "--resolution {} --size 1024 --unlit --draw splats --quiet > '{}/log' 2>&1",
      ranks, programBeside("freevoxels-mpi").string(), volume, folder, frames, resolution, folder);
  const auto start = std::chrono::steady_clock::now();
  if (std::system(command.c_str()) != 0) return {};
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::optional<double> millisecondsOfJob(int ranks, int frames, const std::string& volume, int resolution, const std::string& folder) {
  std::optional<double> least;
  for (int run = 0; run < kRuns; ++run) {
    const std::optional<double> time = millisecondsOfRun(ranks, frames, volume, resolution, folder);
    if (!time) return {};
    least = std::min(least.value_or(*time), *time);
  }
  return least;
}

}  // namespace

std::optional<double> frameOfRealRanks(int ranks, const std::string& volume, int resolution) {
  if (!std::filesystem::exists(programBeside("freevoxels-mpi"))) return {};
  std::string folder = (std::filesystem::temp_directory_path() / "freevoxels-bench.XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return {};
  const std::optional<double> one = millisecondsOfJob(ranks, 1, volume, resolution, folder);
  const std::optional<double> several = one ? millisecondsOfJob(ranks, kFrames, volume, resolution, folder) : std::nullopt;
  std::filesystem::remove_all(folder);
  if (!several) return {};
  return (*several - *one) / (kFrames - 1);
}

}  // namespace freevoxels::bench
