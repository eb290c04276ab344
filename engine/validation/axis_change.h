#pragma once
// A field stored along other axes: index space is permuted and mirrored, the world stays as it was.

#include <glm/glm.hpp>

#include "engine/volume/volume.h"

namespace freevoxels {

struct AxisChange {
  glm::ivec3 axis{0, 1, 2};    ///< new axis i is the old axis axis[i]
  glm::bvec3 mirrored{false};  ///< whether new axis i is reversed

  /// Transforms an old direction.
  glm::ivec3 direction(glm::ivec3 old) const;
  /// Transforms an old voxel of a volume that had `dimensions`.
  glm::ivec3 voxel(glm::ivec3 old, glm::ivec3 dimensions) const;
  Volume apply(const Volume& volume) const;
  ScalarBricks apply(const ScalarBricks& scalars) const;
};

}  // namespace freevoxels
