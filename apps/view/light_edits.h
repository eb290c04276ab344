#pragma once
// Edits of lights by the user.

#include <glm/glm.hpp>

#include "engine/description/scene_description.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// Removes options that have no effect without others, as LightingDescription::check demands.
void dropIdleOptions(LightingDescription& options);

/// Azimuth about +y from +z, and elevation, in degrees, as for --orbit, of a direction of any length but 0.
glm::dvec2 anglesOf(glm::dvec3 direction);
/// The unit vector of these angles.
glm::dvec3 directionOf(glm::dvec2 angles);

/// The direction of a mouse position on a drawn ball of radius 1, with the eye on +z. Beyond its edge it
/// points to the back, the farther away the more. A unit vector.
glm::dvec3 directionOnBall(glm::dvec2 place);

/// A light from the upper left of the camera, or from the upper right where there is an odd number of others: at infinity, or outside of
/// the volume's box. Beside others it is dim.
LightingDescription::GivenLight newLight(const Camera& camera, const Volume& volume, bool atInfinity, std::size_t others);

/// Distance from the middle of the volume's box to its corners.
double halfDiagonal(const Volume& volume);

}  // namespace freevoxels
