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

}  // namespace

Volume coarseVolume(const Volume& volume, int factor, WithoutData withoutData) {
  Volume coarse{.source = volume.source, .dimensions = (volume.dimensions + factor - 1) / factor};
  const glm::dmat4 toMiddle = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5 * (factor - 1)));
  coarse.indexToWorld = volume.indexToWorld * glm::scale(toMiddle, glm::dvec3(factor));
  coarse.scalars = coarseBricks(volume.scalars, coarse.dimensions, factor, withoutData);
  if (volume.temperature) {
    coarse.temperature = TemperatureGrid{.name = volume.temperature->name};
    coarse.temperature->values =
        coarseBricks(volume.temperature->values, coarse.dimensions, factor, WithoutData::Ignored);
    summariseValues(*coarse.temperature);
    coverBricks(coarse, coarse.temperature->values);
  }
  if (volume.albedo) {
    coarse.albedo = AlbedoGrid{.name = volume.albedo->name};
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

}  // namespace freevoxels
