#pragma once
// How much light cells of a volume extinguish, from which ambient light is swept.

#include <vector>

#include "engine/volume/classification.h"

namespace freevoxels {

/// The mean extinction, per world unit, of each cell of `edge` voxels along each axis, x fastest. The part of a cell beyond the volume counts
/// as empty.
std::vector<float> cellExtinctions(const Volume& volume, const Classification& classification, int edge);

}  // namespace freevoxels
