#pragma once
// Timings for noisy machines: the least of several runs, compared with a copy of the same bytes in the same
// run.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"

namespace freevoxels::bench {

struct Result {
  std::string name;               ///< "26 sweeps 128^3"
  double milliseconds = 0.0;      ///< least of all runs
  double copyMilliseconds = 0.0;  ///< copyTime(); 0 if there is no such comparison
  double perSecond = 0.0;         ///< items a second; 0 if not counted
};

/// Milliseconds of the fastest of `runs` calls of `run`, which returns its own time in milliseconds; of more
/// calls if they take less than a third of a second together.
double least(int runs, const std::function<double()>& run);

double millisecondsOf(const std::function<void()>& work);

/// Milliseconds to copy `bytes` in the device's memory, the fastest of a few runs: by the device, or where that is a CPU with two threads.
double copyTime(const Device& device, std::uint64_t bytes);

}  // namespace freevoxels::bench
