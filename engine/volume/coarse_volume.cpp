#include "engine/volume/coarse_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>
#include <vector>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// A brick of the coarse volume and the bricks of the fine one of which it is made.
struct CoarseBrick {
  glm::ivec3 cell;
  std::vector<std::size_t> bricks;
};

/// In the order of their cells.
std::vector<CoarseBrick> coarseBricksOf(const ScalarBricks& fine, const ScalarBricks& coarse, int factor) {
  constexpr int n = ScalarBricks::kEdge;
  const auto cellOf = [&](glm::ivec3 voxel) { return glm::clamp(voxel, glm::ivec3(0), fine.dimensions() - 1) / factor / n; };
  SparseGrid<std::uint32_t> numbers(coarse.cells());  // in `parts`, from 1
  std::vector<CoarseBrick> parts;
  for (std::size_t brick = 0; brick < fine.count(); ++brick) {
    const glm::ivec3 low = cellOf(fine.firstVoxel(brick)), high = cellOf(fine.firstVoxel(brick) + (n - 1));
    for (glm::ivec3 cell = low; cell.z <= high.z; ++cell.z)
      for (cell.y = low.y; cell.y <= high.y; ++cell.y)
        for (cell.x = low.x; cell.x <= high.x; ++cell.x) {
          std::uint32_t& number = numbers[cell];
          if (number == 0) {
            parts.push_back({.cell = cell, .bricks = {}});
            number = std::uint32_t(parts.size());
          }
          parts[number - 1].bricks.push_back(brick);
        }
  }
  std::ranges::sort(parts, {}, [](const CoarseBrick& part) { return std::tuple(part.cell.z, part.cell.y, part.cell.x); });
  return parts;
}

/// Fills a brick of means, of a fine voxel in each of which something is.
void fillCoarse(ScalarBricks::Brick& means, const CoarseBrick& part, const ScalarBricks& fine, int factor, WithoutData withoutData) {
  constexpr int n = ScalarBricks::kEdge;
  std::array<double, std::tuple_size_v<ScalarBricks::Brick>> sums{}, held{};
  const glm::ivec3 begin = part.cell * n * factor,
                   end = glm::ivec3(glm::min(glm::dvec3(begin) + double(n) * factor, glm::dvec3(fine.dimensions())));
  for (const std::size_t brick : part.bricks) {
    const glm::ivec3 place = fine.firstVoxel(brick), low = glm::max(begin - place, 0), high = glm::min(end - place, n);
    for (glm::ivec3 v(0, 0, low.z); v.z < high.z; ++v.z)
      for (v.y = low.y; v.y < high.y; ++v.y)
        for (v.x = low.x; v.x < high.x; ++v.x)
          if (const float scalar = fine.scalarAt(brick, ScalarBricks::indexInBrick(v)); scalar != kInactiveVoxel) {
            const std::size_t to = ScalarBricks::indexInBrick((place + v - begin) / factor);
            sums[to] += withoutData == WithoutData::Zero ? std::max(scalar, 0.0f) : scalar;
            held[to] += 1.0;
          }
  }
  for (glm::ivec3 v(0); v.z < n; ++v.z)
    for (v.y = 0; v.y < n; ++v.y)
      for (v.x = 0; v.x < n; ++v.x) {
        const std::size_t to = ScalarBricks::indexInBrick(v);
        const glm::dvec3 all(glm::min(glm::ivec3(factor), end - begin - v * factor));
        if (held[to] > 0.0) means[to] = float(sums[to] / (withoutData == WithoutData::Zero ? all.x * all.y * all.z : held[to]));
      }
}

ScalarBricks coarseBricks(const ScalarBricks& fine, glm::ivec3 dimensions, int factor, WithoutData withoutData) {
  ScalarBricks result(dimensions);
  const std::vector<CoarseBrick> parts = coarseBricksOf(fine, result, factor);
  std::vector<ScalarBricks::Brick> bricks(parts.size());
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    bricks[i].fill(kInactiveVoxel);
    fillCoarse(bricks[i], parts[i], fine, factor, withoutData);
  });
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (std::ranges::any_of(bricks[i], [](float mean) { return mean != kInactiveVoxel; })) result.makeBrick(parts[i].cell) = bricks[i];
  return result;
}

/// The signed distance of voxels from a plane, above 0 on the side that is clipped, in world units.
struct VoxelDistance {
  glm::dvec3 step;     ///< change for each voxel along x, y and z
  double first = 0.0;  ///< of the box's voxel (0,0,0)

  VoxelDistance(const glm::dmat4& indexToWorld, const ClipPlane& plane) {
    const glm::dvec3 normal = glm::normalize(plane.normal);
    step = normal * glm::dmat3(indexToWorld);
    first = glm::dot(normal, glm::dvec3(indexToWorld[3]) - plane.point);
  }
  double at(glm::dvec3 voxel) const { return first + glm::dot(step, voxel); }
};

/// Whether a brick stays depends on its place alone, so that bricks of scalars still cover those of temperatures.
ScalarBricks clippedBricks(const ScalarBricks& all, const VoxelDistance& distance) {
  constexpr int n = ScalarBricks::kEdge;
  ScalarBricks kept(all.dimensions(), all.corner());
  const glm::dvec3 half = glm::dvec3(0.5 * (n - 1));
  const double reach = glm::dot(glm::abs(distance.step), half);
  for (std::size_t i = 0; i < all.count(); ++i) {
    const glm::ivec3 first = all.firstVoxel(i);
    const double middle = distance.at(glm::dvec3(first) + half);
    if (middle - reach > 0.0) continue;
    ScalarBricks::Brick& brick = kept.makeBrick(all.cell(i)) = all.brick(i);
    if (middle + reach <= 0.0) continue;
    for (glm::ivec3 v(0); v.z < n; ++v.z)
      for (v.y = 0; v.y < n; ++v.y)
        for (v.x = 0; v.x < n; ++v.x)
          if (distance.at(first + v) > 0.0) brick[ScalarBricks::indexInBrick(v)] = kInactiveVoxel;
  }
  return kept;
}

}  // namespace

Volume coarseVolume(const Volume& volume, int factor, WithoutData withoutData) {
  Volume coarse{.source = volume.source, .dimensions = (volume.dimensions + factor - 1) / factor};
  const glm::dmat4 toMiddle = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5 * (factor - 1)));
  coarse.indexToWorld = volume.indexToWorld * glm::scale(toMiddle, glm::dvec3(factor));
  if (volume.temperature)
    coarse.temperature = TemperatureGrid{.name = volume.temperature->name, .isRadiance = volume.temperature->isRadiance};
  if (volume.albedo) coarse.albedo = AlbedoGrid{.name = volume.albedo->name};
  coarse.madeOf = volume.madeOf;
  forEachGrid(
      [&](const ScalarBricks& fine, ScalarBricks& means) {
        means = coarseBricks(fine, coarse.dimensions, factor, &fine == &volume.scalars ? withoutData : WithoutData::Ignored);
      },
      volume, coarse);
  if (coarse.temperature) {
    summariseValues(*coarse.temperature);
    coverBricks(coarse, coarse.temperature->values);
  }
  summariseValues(coarse);
  return coarse;
}

Volume clippedVolume(const Volume& volume, const VoxelBox& box) {
  const glm::ivec3 low = glm::max(box.first, glm::ivec3(0)), high = glm::min(box.last, volume.dimensions - 1);
  for (int axis = 0; axis < 3; ++axis) FV_CHECK_LE(low[axis], high[axis]);
  Volume part = volume;
  part.content = nullptr;
  forEachGrid([&](const ScalarBricks& all, ScalarBricks& kept) { kept = all.cropped(low, high); }, volume, part);
  if (part.temperature) summariseValues(*part.temperature);
  part.dimensions = high - low + 1;
  part.indexOrigin += low;
  part.indexToWorld[3] = volume.indexToWorld * glm::dvec4(glm::dvec3(low), 1.0);
  summariseValues(part);
  part.minimum = volume.minimum;
  part.maximum = volume.maximum;
  return part;
}

Volume clippedVolume(const Volume& volume, const ClipPlane& plane) {
  const VoxelDistance distance(volume.indexToWorld, plane);
  Volume part = volume;
  part.content = nullptr;
  forEachGrid([&](ScalarBricks& bricks) { bricks = clippedBricks(bricks, distance); }, part);
  if (part.temperature) summariseValues(*part.temperature);
  summariseValues(part);
  part.minimum = volume.minimum;
  part.maximum = volume.maximum;
  return part;
}

}  // namespace freevoxels
