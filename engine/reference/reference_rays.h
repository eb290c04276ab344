#pragma once
// Optical depth along the rays of a source, exclusive of the layer: Subr et al. 2007, Eq. 4, summed in double
// precision.

#include <cstdint>
#include <span>

#include "engine/scene/source_rays.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// `extinction` has a value for each voxel.
RayCodes referenceRays(const Volume& volume, std::span<const double> extinction, const RaySource& source);

double decodeRayDepth(std::uint16_t code);

/// Whether a voxel may look up the ray at a plane (counted from the first). Other codes are meaningless.
bool isReadAt(const FaceRays& fan, glm::ivec3 dimensions, glm::ivec2 ray, int plane);

}  // namespace freevoxels
