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

/// A field sampled at the voxel centres of a grid whose longest edge is that of the world cube and whose middle is the cube's:
/// voxel by voxel, for those who cannot hold all of them. May be called by several threads.
class ProceduralField {
 public:
  /// Unknown name or a dimension outside 1..2048: ErrorKind::Usage.
  ProceduralField(std::string_view name, glm::ivec3 dimensions);

  glm::ivec3 dimensions() const { return dimensions_; }
  /// As Volume::indexToWorld.
  glm::dmat4 indexToWorld() const;
  bool hasTemperatures() const;
  bool isFog() const;  ///< as Volume::isFog
  /// kInactiveVoxel where the density is 0; of the temperature, in kelvin, where nothing burns.
  float density(glm::ivec3 voxel) const;
  float temperature(glm::ivec3 voxel) const;
  /// False of a brick of ScalarBricks::kEdge voxels a side only where all are inactive.
  bool mayHoldData(glm::ivec3 firstVoxel) const;

 private:
  glm::vec3 place(glm::ivec3 voxel) const;

  const struct ProceduralFunctions* functions_;  // of all fields that there are
  glm::ivec3 dimensions_;
  double voxelSize_;
  glm::dvec3 firstCentre_;
};

/// All voxels of a field, with its temperatures, if it has any.
Volume makeProcedural(std::string_view name, glm::ivec3 dimensions, const Progress& progress = {});
/// On a grid of resolution³ voxels.
inline Volume makeProcedural(std::string_view name, int resolution) {
  return makeProcedural(name, glm::ivec3(resolution));
}

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
