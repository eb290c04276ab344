#pragma once
// Boxes of equal voxels of size 1, seen straight on: a pixel far smaller than a voxel shows the sum, or the
// product, of a few footprints.

#include <glm/glm.hpp>

#include "engine/scene/camera.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

Volume constantVolume(glm::ivec3 dimensions, const glm::dmat4& transform, double value);

Classification physical(double densityScale, glm::vec3 albedo);

/// The extinction of a voxel of size 1 with this opacity.
double extinctionOf(double opacity);

/// An orthographic camera that looks along -z through (x, y), with an image `height` world units high.
Camera lookingDown(double x, double y, double height);

/// The footprint (engine/scene/footprint.h) at this distance between the ray and the voxel's centre.
double footprintAt(double distance);

}  // namespace freevoxels
