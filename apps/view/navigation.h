#pragma once
// How hands move a camera. Lengths of a drag are parts of the picture's height, upwards and to the right.

#include <glm/glm.hpp>

#include "engine/scene/camera.h"

namespace freevoxels {

/// Around the look-at point, about `up` and the camera's right: half a turn for the picture's height. Stops
/// short of the poles.
Camera orbited(const Camera& camera, glm::dvec2 drag);

/// Eye and look-at point together, so that what is at the look-at point follows the drag.
Camera panned(const Camera& camera, glm::dvec2 drag);

/// Towards the look-at point, whose distance, or the orthographic height, is multiplied by `factor`.
Camera dollied(const Camera& camera, double factor);

/// Turns the head: the look-at point moves around the eye, by the field of view for the picture's height.
Camera turned(const Camera& camera, glm::dvec2 drag);

/// Eye and look-at point together; x to the right, y up, z ahead, in world units.
Camera flown(const Camera& camera, glm::dvec3 way);

/// Looks at the same point from the same distance along +x, -x, +y, -y, +z, -z (`axis` 0 to 5).
Camera alongAxis(const Camera& camera, int axis);

/// The other projection; what is at the look-at point keeps its size.
Camera withOtherProjection(const Camera& camera);

}  // namespace freevoxels
