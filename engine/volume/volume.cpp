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

void cropToActive(Volume& volume) {
  glm::ivec3 low = volume.dimensions, high(-1);
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x)
        if (volume.values[volume.at(x, y, z)] != kInactiveVoxel) {
          low = glm::min(low, glm::ivec3(x, y, z));
          high = glm::max(high, glm::ivec3(x, y, z));
        }
  if (high.x < 0) return;
  const std::vector<float> values = std::move(volume.values);
  Volume cropped = volume;
  cropped.dimensions = high - low + 1;
  cropped.indexOrigin += low;
  cropped.indexToWorld[3] = volume.indexToWorld * glm::dvec4(glm::dvec3(low), 1.0);
  cropped.values.resize(cropped.voxelCount());
  for (int z = 0; z < cropped.dimensions.z; ++z)
    for (int y = 0; y < cropped.dimensions.y; ++y)
      std::copy_n(&values[volume.at(low.x, low.y + y, low.z + z)], cropped.dimensions.x,
                  &cropped.values[cropped.at(0, y, z)]);
  volume = std::move(cropped);
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
