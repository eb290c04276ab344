#pragma once
// Movements of a camera by the user. Lengths of a drag are fractions of the image's height, upwards and to
// the right.

#include <glm/glm.hpp>

#include "engine/scene/camera.h"

namespace freevoxels {

/// Turns around the look-at point, about `up` and the camera's right: half a turn for a drag of the image's
/// height. Stops short of the poles.
Camera orbited(const Camera& camera, glm::dvec2 drag);

/// Moves eye and look-at point together, so that what is at the look-at point follows the drag.
Camera panned(const Camera& camera, glm::dvec2 drag);

/// Moves towards the look-at point: its distance, or the orthographic height, is multiplied by `factor`.
Camera dollied(const Camera& camera, double factor);

/// Turns around the eye: by the field of view for a drag of the image's height.
Camera turned(const Camera& camera, glm::dvec2 drag);

/// Moves eye and look-at point together: x to the right, y up, z ahead, in world units.
Camera flown(const Camera& camera, glm::dvec3 way);

/// Looks at the same point from the same distance along +x, -x, +y, -y, +z, -z (`axis` 0 to 5).
Camera alongAxis(const Camera& camera, int axis);

/// Switches the projection; what is at the look-at point keeps its size.
Camera withOtherProjection(const Camera& camera);

}  // namespace freevoxels
