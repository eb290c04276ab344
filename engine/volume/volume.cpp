#include "engine/volume/volume.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace freevoxels {

namespace {

struct Summary {
  std::uint64_t active = 0, nan = 0, negative = 0;
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();
};

Summary join(const Summary& a, const Summary& b) {
  return {a.active + b.active, a.nan + b.nan, a.negative + b.negative, std::min(a.minimum, b.minimum),
          std::max(a.maximum, b.maximum)};
}

/// Also replaces NaN and infinities by 0.
void add(Summary& summary, float& value) {
  if (value == kInactiveVoxel) return;
  ++summary.active;
  if (!std::isfinite(value)) {
    ++summary.nan;
    value = 0.0f;
  }
  if (value < 0.0f) ++summary.negative;
  summary.minimum = std::min(summary.minimum, value);
  summary.maximum = std::max(summary.maximum, value);
}

}  // namespace

double Volume::voxelSize() const {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(indexToWorld))));
}

void summariseValues(Volume& volume) {
  using Range = tbb::blocked_range<std::size_t>;
  constexpr std::size_t kGrain = 1 << 16;
  const Summary summary = tbb::parallel_reduce(
      Range(0, volume.values.size(), kGrain), Summary{},
      [&](const Range& range, Summary partial) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) add(partial, volume.values[i]);
        return partial;
      },
      join);
  volume.activeVoxels = summary.active;
  volume.nanVoxels = summary.nan;
  volume.negativeVoxels = summary.negative;
  volume.minimum = summary.active ? summary.minimum : 0.0f;
  volume.maximum = summary.active ? summary.maximum : 0.0f;
}

}  // namespace freevoxels
