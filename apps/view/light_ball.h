#pragma once
// A ball in the light of one direction, to be dragged.

#include <glm/glm.hpp>

namespace freevoxels {

/// `direction` leads towards the light, in the camera's space: right, up, towards the eye; of length 1. As
/// wide as `size` on the screen. True where a hand changed it.
bool drawLightBall(const char* name, float size, glm::dvec3& direction, glm::dvec3 color);

}  // namespace freevoxels
