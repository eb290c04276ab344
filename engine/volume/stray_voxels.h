#pragma once
// Few voxels that lie far from all others and make the box of a volume large, as errors of simulations and conversions leave them.

#include <cstdint>
#include <optional>

#include "engine/volume/coarse_volume.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct StrayVoxels {
  std::uint64_t count = 0;  ///< voxels with data that are not in `others`
  VoxelBox others;          ///< the box of all other voxels, in whole bricks or up to the volume's box
};

/// Nothing unless a box of at least 0.998 of the voxels with data is so much shorter than the volume's that it fills less than a sixteenth
/// of an image of all.
std::optional<StrayVoxels> strayVoxels(const Volume& volume);

/// Warns of them, with the clip box that leaves them out.
void warnOfStrayVoxels(Volume& volume);

}  // namespace freevoxels
