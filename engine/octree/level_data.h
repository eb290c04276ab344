#pragma once
// A level of the octree on the host: Subr et al. 2007, Section 3.2.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// Of every block, x fastest.
struct LevelData {
  glm::ivec3 dimensions{0};
  std::vector<double> extinction;                ///< per world unit
  std::vector<glm::dvec3> colors;                ///< empty where all are the albedo
  std::vector<glm::dvec3> emission = {};         ///< per world unit; empty where no block sends out light
  std::vector<std::vector<std::uint8_t>> table;  ///< bytes [direction][block], any where nothing is held
  /// The same of each block's most transparent voxel, as half a byte keeps it; empty for level 0.
  std::vector<std::vector<std::uint8_t>> bounds;

  /// Whether a block has extinction or sends out light.
  bool isOccupied(std::size_t block) const {
    return extinction[block] > 0.0 || (!emission.empty() && emission[block] != glm::dvec3(0.0));
  }
  std::size_t at(glm::ivec3 cell) const {
    return std::size_t(cell.x) + std::size_t(dimensions.x) *
                                     (std::size_t(cell.y) + std::size_t(dimensions.y) * std::size_t(cell.z));
  }
};

}  // namespace freevoxels
