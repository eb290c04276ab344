#pragma once
// Cameras that fly through a volume: from outside to its centre and out again on the other side.

#include <vector>

#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// At even steps along a line through the centre of the box, from 1.5 times its longest edge before it to as
/// far behind it, 60 degrees wide. The first looks where it flies; on the middle of the way the view turns
/// about +y, and the last looks back. `frames` is at least 2.
std::vector<Camera> flyThrough(const Volume& volume, int frames);

}  // namespace freevoxels
