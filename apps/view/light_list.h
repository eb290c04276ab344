#pragma once
// The lights of a scene, each with what can be changed of it.

#include "apps/freevoxels/lighting_options.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// `camera` is where the picture is seen from. True where a light was changed.
bool drawLights(LightingOptions& options, const Camera& camera, const Volume& volume);

}  // namespace freevoxels
