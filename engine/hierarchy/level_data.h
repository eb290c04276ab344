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
  std::vector<std::vector<std::uint8_t>> table;  ///< bytes [direction][block], any where extinction is 0
  /// The same of each block's most transparent voxel; empty for level 0.
  std::vector<std::vector<std::uint8_t>> bounds;

  std::size_t at(glm::ivec3 cell) const {
    return std::size_t(cell.x) + std::size_t(dimensions.x) *
                                     (std::size_t(cell.y) + std::size_t(dimensions.y) * std::size_t(cell.z));
  }
};

}  // namespace freevoxels
