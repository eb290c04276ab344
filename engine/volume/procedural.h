#pragma once
// Volumes made in code, for demonstration and tests. All fill the world cube [-1/2, 1/2]³ or part of it.

#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/volume.h"

namespace freevoxels {

struct ProceduralKind {
  std::string_view name;  ///< "cube", "cloud", "plume", "fire", "marschner-lobb", "shells", "rods", "head"
  std::string_view description;  ///< one clause
};

const std::vector<ProceduralKind>& proceduralKinds();

/// The field `name` sampled at the voxel centres of a resolution³ grid, with its temperatures, if it has any.
/// Voxels of value 0 are inactive.
/// Unknown name or a resolution outside 1..2048: ExitCode::Usage.
Volume makeProcedural(std::string_view name, int resolution);

/// A volume from a function of the continuous index position: tests fill it from a lambda that also predicts
/// the answer, and which is called x fastest by one thread. Zero values are active too.
template <typename Function>
Volume makeVolume(glm::ivec3 dimensions, const glm::dmat4& indexToWorld, Function&& valueAt) {
  Volume volume;
  volume.source = "procedural";
  volume.dimensions = dimensions;
  volume.indexToWorld = indexToWorld;
  std::vector<float> values;
  values.reserve(volume.voxelCount());
  for (int z = 0; z < dimensions.z; ++z)
    for (int y = 0; y < dimensions.y; ++y)
      for (int x = 0; x < dimensions.x; ++x) values.push_back(float(valueAt(x, y, z)));
  volume.scalars =
      ScalarBricks::make(dimensions, [&](glm::ivec3 v) { return values[volume.at(v.x, v.y, v.z)]; });
  summariseValues(volume);
  return volume;
}

}  // namespace freevoxels
