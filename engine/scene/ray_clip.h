#pragma once
// The part of a volume in which rays are marched, for drafts.

#include <glm/glm.hpp>

namespace freevoxels {

/// A box, and optionally what lies behind a plane, in index space: the centre of voxel (i, j, k) has the position (i, j, k), and the voxel
/// reaches half a voxel further on each side.
struct RayClip {
  glm::dvec3 low{-0.5}, high{0.0};  ///< corners of the box; `low` is less than `high` on each axis
  glm::dvec3 normal{0.0};           ///< of length 1 towards what is clipped, or 0 if there is no plane
  double distance = 0.0;            ///< dot(normal, p) of points p on the plane

  bool operator==(const RayClip&) const = default;
};

}  // namespace freevoxels
