#pragma once
// A volume as the engine sees it: a box of scalars and where it stands in the world.

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/volume/scalar_bricks.h"

namespace freevoxels {

struct Volume {
  std::string source;  ///< file and grid, for messages and metadata: "cloud.vdb density[1]"
  glm::ivec3 dimensions{0};
  glm::ivec3 indexOrigin{0};  ///< of voxel (0,0,0) in the file's own index space
  /// Affine. Maps (i,j,k) of this box, 0 <= i < dimensions.x, to the world position of that voxel's centre.
  glm::dmat4 indexToWorld{1.0};
  ScalarBricks scalars;  ///< of the same dimensions. Finite, or kInactiveVoxel

  std::uint64_t activeVoxels = 0;
  std::uint64_t nanVoxels = 0;  ///< active voxels that were NaN or infinite; their value is 0 here
  std::uint64_t negativeVoxels =
      0;  ///< active voxels below 0; a density there counts as 0 (classification.h)
  float minimum = 0.0f, maximum = 0.0f;  ///< of the active voxels

  std::size_t voxelCount() const {
    return std::size_t(dimensions.x) * std::size_t(dimensions.y) * std::size_t(dimensions.z);
  }
  float scalar(int x, int y, int z) const { return scalars.at({x, y, z}); }
  /// Of a voxel among all of them, x fastest.
  std::size_t at(int x, int y, int z) const {
    return std::size_t(x) +
           std::size_t(dimensions.x) * (std::size_t(y) + std::size_t(dimensions.y) * std::size_t(z));
  }
  /// Edge of the cube that has a voxel's world volume: the Δ of design and paper.
  double voxelSize() const;
};

/// Of all voxels, x fastest: for references and tests, which look at every one.
std::vector<float> denseScalars(const Volume& volume);

/// Fills activeVoxels, nanVoxels, negativeVoxels, minimum and maximum, and replaces NaN and infinities by 0.
void summariseValues(Volume& volume);

/// Drops the planes at the box's six sides that hold no active voxel; every voxel keeps its place in the
/// world. A volume without active voxels stays as it is.
void cropToActive(Volume& volume);

}  // namespace freevoxels
