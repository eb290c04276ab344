#include "engine/volume/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/volume/value_range.h"

namespace freevoxels {

namespace {

/// Fills what a volume and its temperatures have in common.
template <typename Grid>
void take(Grid& grid, const ValueSummary& summary, const Outliers& outliers) {
  grid.activeVoxels = summary.active;
  grid.nanVoxels += summary.nan;
  std::tie(grid.minimum, grid.maximum) = rangeOf(summary, outliers);
  if (outliers.voxels == 0) return;
  grid.outlierVoxels = outliers.voxels;
  grid.farthestOutlier = std::abs(summary.minimum) > std::abs(summary.maximum) ? summary.minimum : summary.maximum;
}

void expandByActive(const ScalarBricks& scalars, glm::ivec3& low, glm::ivec3& high) {
  constexpr int n = ScalarBricks::kEdge;
  for (std::size_t i = 0; i < scalars.count(); ++i) {
    const ScalarBricks::Brick brick = scalars.brick(i);
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
  for (std::size_t i = 0; i < grid.count(); ++i) volume.scalars.makeBrick(grid.cell(i));
}

void cropToActive(Volume& volume) {
  glm::ivec3 low = volume.dimensions, high(-1);
  expandByActive(volume.scalars, low, high);
  if (volume.temperature) expandByActive(volume.temperature->values, low, high);
  if (high.x < 0) return;
  forEachGrid([&](ScalarBricks& values) { values = values.cropped(low, high); }, volume);
  volume.dimensions = high - low + 1;
  volume.indexOrigin += low;
  volume.indexToWorld[3] = volume.indexToWorld * glm::dvec4(glm::dvec3(low), 1.0);
}

void normaliseWorld(Volume& volume) {
  constexpr double kFarthest = 1e10;                    // voxels from the origin
  constexpr double kSmallest = 1e-18, kLargest = 1e9;   // world units of a voxel; squares of distances are single-precision floats
  const double voxel = volume.voxelSize();
  const glm::dvec3 centre(volume.indexToWorld * glm::dvec4((glm::dvec3(volume.dimensions) - 1.0) / 2.0, 1.0));
  if (glm::length(centre) > kFarthest * voxel) {
    volume.indexToWorld[3] -= glm::dvec4(centre, 0.0);
    volume.warnings.push_back(
        fmt::format("{} is so far from the origin that its voxels can hardly be told apart: its middle, {:g},{:g},{:g}, becomes the "
                    "origin, from which positions of cameras and lights count",
                    volume.source, centre.x, centre.y, centre.z));
  }
  if (voxel > kLargest || voxel < kSmallest) {
    const double scale = std::pow(10.0, -std::floor(std::log10(voxel)));
    for (int column = 0; column < 4; ++column)
      volume.indexToWorld[column] = glm::dvec4(glm::dvec3(volume.indexToWorld[column]) * scale, column == 3);
    volume.lengthUnit.clear();
    volume.warnings.push_back(
        fmt::format("voxels of {} are {:g} world units large: it is scaled by {:g}, so that the camera, the lights and the scale of "
                    "densities count in units of {:g}",
                    volume.source, voxel, scale, 1.0 / scale));
  }
}

void summariseValues(Volume& volume, std::optional<float> noData) {
  const ValueSummary summary = summarise(volume.scalars, noData);
  const Outliers outliers = outliersOf(summary);
  takeSummary(volume, summary, outliers);
  if (outliers.voxels > 0) limitValues(volume.scalars, outliers.limit);
}

void summariseValues(Volume& volume, const Outliers& outliers) {
  if (outliers.voxels > 0) limitValues(volume.scalars, outliers.limit);
  takeSummary(volume, summarise(volume.scalars), {});
}

void takeSummary(Volume& volume, const ValueSummary& summary, const Outliers& outliers) {
  take(volume, summary, outliers);
  volume.negativeVoxels = summary.negative;
  volume.missingVoxels += summary.missing;
}

void takeCounts(Volume& volume, const Volume& other) {
  volume.nanVoxels = other.nanVoxels;
  volume.negativeVoxels = other.negativeVoxels;
  volume.overflownVoxels = other.overflownVoxels;
  volume.outlierVoxels = other.outlierVoxels;
  volume.farthestOutlier = other.farthestOutlier;
  volume.minimum = other.minimum;
  volume.maximum = other.maximum;
}

void summariseValues(TemperatureGrid& grid) {
  const ValueSummary summary = summarise(grid.values);
  const Outliers outliers = outliersOf(summary);
  take(grid, summary, outliers);
  if (outliers.voxels > 0) limitValues(grid.values, outliers.limit);
}

Volume outlineOf(const Volume& volume) {
  Volume outline{.source = volume.source,
                 .dimensions = volume.dimensions,
                 .indexOrigin = volume.indexOrigin,
                 .indexToWorld = volume.indexToWorld,
                 .up = volume.up,
                 .upReason = volume.upReason,
                 .lengthUnit = volume.lengthUnit,
                 .valueUnit = volume.valueUnit,
                 .isSolid = volume.isSolid,
                 .activeVoxels = volume.activeVoxels,
                 .nanVoxels = volume.nanVoxels,
                 .negativeVoxels = volume.negativeVoxels,
                 .minimum = volume.minimum,
                 .maximum = volume.maximum};
  if (volume.temperature) {
    const TemperatureGrid& grid = *volume.temperature;
    outline.temperature = TemperatureGrid{.name = grid.name,
                                          .isRadiance = grid.isRadiance,
                                          .activeVoxels = grid.activeVoxels,
                                          .nanVoxels = grid.nanVoxels,
                                          .minimum = grid.minimum,
                                          .maximum = grid.maximum};
  }
  if (volume.albedo) outline.albedo = AlbedoGrid{.name = volume.albedo->name, .clippedVoxels = volume.albedo->clippedVoxels};
  outline.madeOf = volume.madeOf;
  return outline;
}

}  // namespace freevoxels
