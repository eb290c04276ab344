#pragma once
// Movements of a camera by the user. Lengths of a drag are fractions of the image's height, upwards and to
// the right.

#include <glm/glm.hpp>

#include "engine/scene/camera.h"

namespace freevoxels {

// `pole` is the direction that the user calls up: that of the volume. A camera that looks along it has another `up`, which shows what is up
// on its image; drags turn about the pole all the same, as a turntable does.

/// Turns around the look-at point, about the pole and the camera's right: half a turn for a drag of the image's
/// height. Stops short of the poles. Leaves the pole as the camera's `up`.
Camera orbited(const Camera& camera, const glm::dvec3& pole, glm::dvec2 drag);

/// Moves eye and look-at point together, so that what is at the look-at point follows the drag.
Camera panned(const Camera& camera, glm::dvec2 drag);

/// Moves towards the look-at point: its distance, or the orthographic height, is multiplied by `factor`.
Camera dollied(const Camera& camera, double factor);

/// Turns around the eye: by the field of view for a drag of the image's height. Leaves the pole as the camera's `up`.
Camera turned(const Camera& camera, const glm::dvec3& pole, glm::dvec2 drag);

/// Moves eye and look-at point together: x to the right, y up, z ahead, in world units.
Camera flown(const Camera& camera, glm::dvec3 way);

/// Looks at the same point from the same distance from +x, -x, +y, -y, +z, -z (`axis` 0 to 5), with the pole upwards on the image; along
/// the pole with the front of the volume at the lower edge, seen from above: -y where the pole is z, else +z.
Camera alongAxis(const Camera& camera, const glm::dvec3& pole, int axis);

/// Switches the projection; what is at the look-at point keeps its size.
Camera withOtherProjection(const Camera& camera);

}  // namespace freevoxels
