#pragma once
// What of a volume shows, for a first view of it.

#include "engine/splatting/camera.h"
#include "engine/volume/classification.h"

namespace freevoxels {

/// The parts of the volume that are seen, in cells of 1/64 of its longest side: those with extinction or emission, but for
/// densities below 1/256 of the largest. The whole box where there are none.
Subject contentOf(const Volume& volume, const Classification& classification);

}  // namespace freevoxels
