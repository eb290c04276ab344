#pragma once
// How often each value is in a volume.

#include <cstdint>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

struct Histogram {
  float minimum = 0.0f, maximum = 0.0f;  ///< of the active voxels
  /// Of bins of equal width from one to the other, the last with the maximum in it.
  std::vector<std::uint64_t> counts;

  /// The largest count of any bin that the values from `low` to `high` are in; 0 where there is none.
  std::uint64_t countBetween(double low, double high) const;
};

/// Of the active voxels; the same whatever the number of threads. All of a uniform volume are in the first
/// bin. `bins` is at least 1.
Histogram histogramOf(const Volume& volume, int bins);

}  // namespace freevoxels
