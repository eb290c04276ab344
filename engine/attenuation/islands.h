#pragma once
// Boxes around the parts of a volume that lie far apart, so that lights are swept through these and not through the empty space between.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/sparse_grid.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

/// Disjoint boxes of voxels, of whole bricks or up to `dimensions`, in which all marked bricks are: each is the smallest around marked
/// bricks of which neighbouring nodes (SparseGrid) have some, and around others that overlap it. At most kMaxIslands; where there would be
/// more, those that are near each other have one box.
std::vector<VoxelRange> islandsOf(const SparseGrid<std::uint8_t>& bricks, glm::ivec3 dimensions);

inline constexpr std::size_t kMaxIslands = 1024;

}  // namespace freevoxels
