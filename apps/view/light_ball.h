#pragma once
// A ball that shows the direction of a light, and can be dragged.

#include <glm/glm.hpp>

namespace freevoxels {

/// `direction` is the unit vector towards the light in camera space: right, up, towards the eye. `size` is
/// the width on the screen. Returns true if the user changed it.
bool drawLightBall(const char* name, float size, glm::dvec3& direction, glm::dvec3 color);

}  // namespace freevoxels
