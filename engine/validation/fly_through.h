#pragma once
// Cameras of a flight through a volume: from outside to its centre and out again on the other side.

#include <vector>

#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Equal steps along a line through the centre of the box, from 1.5 times its longest edge in front of it to
/// the same distance behind it, with a field of view of 60 degrees. The first camera looks ahead; in the
/// middle of the path the view turns about +y, and the last camera looks back. `frames` is at least 2.
std::vector<Camera> flyThrough(const Volume& volume, int frames);

}  // namespace freevoxels
