#pragma once
// How many blocks an octree over a box stores, counted on the host.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// Counts, for each level of the octree over a box of `dimensions` voxels, the blocks that contain an occupied voxel: level 0 (the
/// voxels) first, the root last. `occupied` has an entry per voxel, x fastest.
std::vector<std::uint64_t> countOccupiedBlocks(glm::ivec3 dimensions, std::vector<bool> occupied);

}  // namespace freevoxels
