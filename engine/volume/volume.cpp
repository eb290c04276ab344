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

/// Adds a value to the summary, and replaces it by 0 if it is NaN or infinite.
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

Summary summarise(std::span<ScalarBricks::Brick> bricks) {
  using Range = tbb::blocked_range<std::size_t>;
  constexpr std::size_t kGrain = 64;
  Summary summary = tbb::parallel_reduce(
      Range(0, bricks.size(), kGrain), Summary{},
      [&](const Range& range, Summary partial) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          for (float& scalar : bricks[i]) add(partial, scalar);
        return partial;
      },
      join);
  if (summary.active == 0) summary.minimum = summary.maximum = 0.0f;
  return summary;
}

void expandByActive(const ScalarBricks& scalars, glm::ivec3& low, glm::ivec3& high) {
  constexpr int n = ScalarBricks::kEdge;
  for (std::size_t i = 0; i < scalars.bricks().size(); ++i) {
    const ScalarBricks::Brick& brick = scalars.bricks()[i];
    for (glm::ivec3 v(0); v.z < n; ++v.z)
      for (v.y = 0; v.y < n; ++v.y)
        for (v.x = 0; v.x < n; ++v.x)
          if (brick[ScalarBricks::indexInBrick(v)] != kInactiveVoxel) {
            low = glm::min(low, scalars.firstVoxel(i) + v);
            high = glm::max(high, scalars.firstVoxel(i) + v);
          }
  }
}

}  // namespace

double Volume::voxelSize() const {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(indexToWorld))));
}

std::vector<float> denseScalars(const Volume& volume) {
  std::vector<float> dense;
  dense.reserve(volume.voxelCount());
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x) dense.push_back(volume.scalar(x, y, z));
  return dense;
}

void coverBricks(Volume& volume, const ScalarBricks& grid) {
  for (std::size_t i = 0; i < grid.bricks().size(); ++i) volume.scalars.makeBrick(grid.cell(i));
}

void cropToActive(Volume& volume) {
  glm::ivec3 low = volume.dimensions, high(-1);
  expandByActive(volume.scalars, low, high);
  if (volume.temperature) expandByActive(volume.temperature->values, low, high);
  if (high.x < 0) return;
  volume.scalars = volume.scalars.cropped(low, high);
  if (volume.temperature) volume.temperature->values = volume.temperature->values.cropped(low, high);
  if (volume.albedo)
    for (ScalarBricks& values : volume.albedo->values) values = values.cropped(low, high);
  volume.dimensions = high - low + 1;
  volume.indexOrigin += low;
  volume.indexToWorld[3] = volume.indexToWorld * glm::dvec4(glm::dvec3(low), 1.0);
}

void summariseValues(Volume& volume) {
  const Summary summary = summarise(volume.scalars.bricks());
  volume.activeVoxels = summary.active;
  volume.nanVoxels = summary.nan;
  volume.negativeVoxels = summary.negative;
  volume.minimum = summary.minimum;
  volume.maximum = summary.maximum;
}

void summariseValues(TemperatureGrid& grid) {
  const Summary summary = summarise(grid.values.bricks());
  grid.activeVoxels = summary.active;
  grid.nanVoxels = summary.nan;
  grid.minimum = summary.minimum;
  grid.maximum = summary.maximum;
}

}  // namespace freevoxels
