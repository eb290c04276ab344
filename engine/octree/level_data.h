#pragma once
// A copy of a level of the octree on the host, for validation: Subr et al. 2007, Section 3.2.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// The data of every block of the level, x fastest.
struct LevelData {
  glm::ivec3 dimensions{0};
  std::vector<double> extinction;                ///< per world unit
  std::vector<glm::dvec3> colors;                ///< empty if all blocks have the albedo
  std::vector<glm::dvec3> emission = {};         ///< per world unit; empty if no block emits light
  std::vector<std::vector<std::uint8_t>> table;  ///< bytes [direction][block]; undefined for blocks that are not occupied
  /// Bytes [direction][block] of each block's most transparent voxel, as half a byte keeps them; empty for
  /// level 0.
  std::vector<std::vector<std::uint8_t>> bounds;

  /// Whether a block has extinction or emission.
  bool isOccupied(std::size_t block) const {
    return extinction[block] > 0.0 || (!emission.empty() && emission[block] != glm::dvec3(0.0));
  }
  std::size_t at(glm::ivec3 cell) const {
    return std::size_t(cell.x) + std::size_t(dimensions.x) *
                                     (std::size_t(cell.y) + std::size_t(dimensions.y) * std::size_t(cell.z));
  }
};

}  // namespace freevoxels
