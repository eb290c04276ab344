#pragma once
// Volumes computed in code, for demonstrations and tests. All lie in the world cube [-1/2, 1/2]³.

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

/// Samples the field `name` and its temperatures, if it has any, at the voxel centres of a resolution³ grid.
/// Voxels of value 0 are inactive. An unknown name or a resolution outside of 1..2048 fails with
/// ExitCode::Usage.
Volume makeProcedural(std::string_view name, int resolution);

/// Makes a volume from a function of the continuous index position. Tests use one lambda to fill it and to
/// predict the answer. The function is called in the order of x fastest by one thread. Values of 0 are
/// active.
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
