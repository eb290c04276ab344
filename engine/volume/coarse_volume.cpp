#include "engine/volume/coarse_volume.h"

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

ScalarBricks coarseBricks(const ScalarBricks& fine, glm::ivec3 dimensions, int factor,
                          WithoutData withoutData) {
  return ScalarBricks::make(dimensions, [&](glm::ivec3 cell) {
    const glm::ivec3 first = cell * factor, end = glm::min(first + factor, fine.dimensions());
    double sum = 0.0;
    int held = 0, all = 0;
    for (int z = first.z; z < end.z; ++z)
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x, ++all)
          if (const float scalar = fine.at({x, y, z}); scalar != kInactiveVoxel) sum += scalar, ++held;
    if (held == 0) return kInactiveVoxel;
    return float(sum / (withoutData == WithoutData::Zero ? all : held));
  });
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
  for (std::size_t i = 0; i < all.bricks().size(); ++i) {
    const glm::ivec3 first = all.firstVoxel(i);
    const double middle = distance.at(glm::dvec3(first) + half);
    if (middle - reach > 0.0) continue;
    ScalarBricks::Brick& brick = kept.makeBrick(all.cell(i)) = all.bricks()[i];
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
  coarse.scalars = coarseBricks(volume.scalars, coarse.dimensions, factor, withoutData);
  if (volume.temperature) {
    coarse.temperature = TemperatureGrid{.name = volume.temperature->name, .isRadiance = volume.temperature->isRadiance};
    coarse.temperature->values =
        coarseBricks(volume.temperature->values, coarse.dimensions, factor, WithoutData::Ignored);
    summariseValues(*coarse.temperature);
    coverBricks(coarse, coarse.temperature->values);
  }
  if (volume.albedo) {
    coarse.albedo = AlbedoGrid{.name = volume.albedo->name, .isMade = volume.albedo->isMade};
    for (std::size_t c = 0; c < coarse.albedo->values.size(); ++c)
      coarse.albedo->values[c] =
          coarseBricks(volume.albedo->values[c], coarse.dimensions, factor, WithoutData::Ignored);
  }
  summariseValues(coarse);
  return coarse;
}

Volume clippedVolume(const Volume& volume, const VoxelBox& box) {
  const glm::ivec3 low = glm::max(box.first, glm::ivec3(0)), high = glm::min(box.last, volume.dimensions - 1);
  for (int axis = 0; axis < 3; ++axis) FV_CHECK_LE(low[axis], high[axis]);
  Volume part = volume;
  part.content = nullptr;
  part.scalars = volume.scalars.cropped(low, high);
  if (volume.temperature) {
    part.temperature->values = volume.temperature->values.cropped(low, high);
    summariseValues(*part.temperature);
  }
  if (volume.albedo)
    for (std::size_t c = 0; c < volume.albedo->values.size(); ++c)
      part.albedo->values[c] = volume.albedo->values[c].cropped(low, high);
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
  const auto clip = [&](ScalarBricks& bricks) { bricks = clippedBricks(bricks, distance); };
  clip(part.scalars);
  if (part.temperature) {
    clip(part.temperature->values);
    summariseValues(*part.temperature);
  }
  if (part.albedo)
    for (ScalarBricks& values : part.albedo->values) clip(values);
  summariseValues(part);
  part.minimum = volume.minimum;
  part.maximum = volume.maximum;
  return part;
}

}  // namespace freevoxels
