#pragma once
// Volumes of scalars that the caller has in memory, for those who read arrays.

#include <glm/glm.hpp>

#include "engine/volume/volume.h"

namespace freevoxels {

/// The affine map of voxels `spacing` world units apart along x, y and z, the centre of whose first one is at `origin`.
glm::dmat4 latticeTransform(const glm::dvec3& spacing, const glm::dvec3& origin);

/// A volume named "the array" of these scalars (Volume::scalars), `indexToWorld` as Volume::indexToWorld. Fails with
/// ExitCode::Input where no scalar is active, or `indexToWorld` is not finite or gives voxels no extent.
Volume volumeOfScalars(ScalarBricks scalars, const glm::dmat4& indexToWorld);

}  // namespace freevoxels
