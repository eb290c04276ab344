#pragma once
// Which blocks of the octree a frame draws: the level is chosen by the size on the image, Subr et al. 2007,
// Section 3.3.

#include <glm/glm.hpp>

#include "engine/octree/hierarchy_layout.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// A block is small where its edge is at most `edgePerDistance` times the least distance of its cube from the
/// eye plane. It is drawn where it is small, or of the finest level, and its parent is not, or is of a level
/// above the coarsest. A parent is twice as large as its children and as near as the nearest of them: around
/// every voxel exactly one block is drawn.
struct DetailRule {
  int finest = 0, coarsest = 0;  ///< no other levels are drawn from here
  double edgePerDistance = 0.0;  ///< voxels a world unit; perspective
  glm::dvec3 viewAxis{0.0};      ///< a position's distance from the eye plane is viewAxis . (position - eye)
  glm::dvec3 eye{0.0};           ///< index space; perspective

  bool isOneLevel() const { return finest == coarsest; }
  /// Of a block's cube, which may reach beyond the volume.
  double nearestDistance(const Block& block) const;
  bool isSmall(const Block& block) const;
};

/// Blocks of at most `lod` pixels; 0: voxels. The edge of a block counts as long as it can be, whichever way
/// it points and wherever in the image it is, at the block's distance. Whatever `lod` is, no block's kernel
/// reaches the eye plane.
DetailRule detailRule(const HierarchyLayout& hierarchy, const PixelRays& rays, glm::ivec2 imageSize,
                      double lod);

}  // namespace freevoxels
