#pragma once
// Blocks of the octree as coloured squares, the nearest in front.

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/octree/hierarchy_layout.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// The linear colour of a level; colours repeat after six levels.
glm::vec3 levelColor(int level);

struct PaintedBlock {
  Block block;
  glm::vec3 color{0.0f};  ///< linear
};

/// An opaque image over black. The blocks belong to a volume of these dimensions.
Image paintBlocks(std::span<const PaintedBlock> blocks, glm::ivec3 dimensions, const glm::dmat4& indexToWorld,
                  const Camera& camera, glm::ivec2 size);

/// The voxels that are in none of the blocks `drawn`: those that were left out.
std::vector<Block> leftOut(std::span<const Block> drawn, std::span<const Block> voxels);

}  // namespace freevoxels
