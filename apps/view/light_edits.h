#pragma once
// How hands change lights.

#include <glm/glm.hpp>

#include "apps/freevoxels/lighting_options.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// Takes out what says nothing without what is not there, as LightingOptions::check demands.
void dropIdleOptions(LightingOptions& options);

/// Azimuth about +y from +z and elevation, in degrees, as of --orbit. Of any length but 0.
glm::dvec2 anglesOf(glm::dvec3 direction);
/// Of length 1.
glm::dvec3 directionOf(glm::dvec2 angles);

/// Where a hand on a drawn ball of radius 1 points, towards the eye on +z; beyond its edge it points to the
/// back, and farther away the nearer to the middle of that. Of length 1.
glm::dvec3 directionOnBall(glm::dvec2 place);

/// A light from the upper left of the camera: at infinity, or outside of the volume's box.
LightingOptions::GivenLight newLight(const Camera& camera, const Volume& volume, bool atInfinity);

/// From the middle of the volume's box to its corners.
double halfDiagonal(const Volume& volume);

}  // namespace freevoxels
