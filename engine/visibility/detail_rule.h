#pragma once
// Which levels of the octree a frame draws, chosen by size on the image: Subr et al. 2007, Section 3.3.

#include <glm/glm.hpp>

#include "engine/octree/hierarchy_layout.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// A block is small if its edge is at most `edgePerDistance` times the least distance of its cube from the
/// eye plane. It is drawn if it is small or of the finest level, and its parent is neither, or is above the
/// coarsest level. A parent is twice as large as its children and as near as the nearest of them. Therefore
/// exactly one block is drawn around every voxel.
struct DetailRule {
  int finest = 0, coarsest = 0;  ///< range of the levels that this frame can draw
  double edgePerDistance = 0.0;  ///< voxels per world unit; perspective only
  /// Orthographic only: share of the volume's depth, from its far end, in which a gathered frame draws the coarsest level; nearer to the
  /// eye it draws the next finer one. Grows from 0 to 1 while a zoom makes the coarsest level's blocks a fifth smaller than `lod`, so
  /// that the level does not change in one frame. Splats are all of the coarsest level.
  double coarsestShare = 1.0;
  glm::dvec3 viewAxis{0.0};      ///< a position's distance from the eye plane is viewAxis . (position - eye)
  glm::dvec3 eye{0.0};           ///< in index space; perspective only

  bool isOneLevel() const { return finest == coarsest; }
  /// Least distance from the eye plane of a block's cube, which may reach beyond the volume.
  double nearestDistance(const Block& block) const;
  bool isSmall(const Block& block) const;
};

/// The rule for blocks of at most `lod` pixels; 0 draws voxels. The length of a block's edge is the largest
/// that it can have at its distance, in any orientation and anywhere in the image. Whatever `lod` is, no
/// block's kernel reaches the eye plane.
DetailRule detailRule(const HierarchyLayout& hierarchy, const PixelRays& rays, glm::ivec2 imageSize,
                      double lod);

}  // namespace freevoxels
