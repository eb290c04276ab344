#pragma once
// Histograms of a volume's values.

#include <cstdint>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

struct Histogram {
  float minimum = 0.0f, maximum = 0.0f;  ///< of the active voxels
  /// Counts of bins of equal width from minimum to maximum. The last bin includes the maximum.
  std::vector<std::uint64_t> counts;

  /// The largest count among the bins that overlap `low` to `high`; 0 if there are none.
  std::uint64_t countBetween(double low, double high) const;
};

/// The histogram of the active voxels, with at least 1 bin. The result does not depend on the number of
/// threads. All voxels of a uniform volume are in the first bin.
Histogram histogramOf(const Volume& volume, int bins);

}  // namespace freevoxels
