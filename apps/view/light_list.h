#pragma once
// The lights of a scene with their settings.

#include "apps/freevoxels/lighting_options.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// `camera` is that of the image. Returns true if a light was changed.
bool drawLights(LightingOptions& options, const Camera& camera, const Volume& volume);

}  // namespace freevoxels
