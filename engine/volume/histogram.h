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
  /// The number of all values.
  std::uint64_t count() const;
  /// The bin of the value that has so many values up to it, itself included; the last bin where there are fewer values.
  std::size_t binOfRank(double rank) const;
};

/// The histogram of the active voxels, with at least 1 bin. The result does not depend on the number of
/// threads. All voxels of a uniform volume are in the first bin.
Histogram histogramOf(const Volume& volume, int bins);
/// The same of scalars whose smallest and largest are known.
Histogram histogramOf(const ScalarBricks& scalars, float minimum, float maximum, int bins);

}  // namespace freevoxels
