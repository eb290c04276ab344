#pragma once
// A volume with fewer voxels, for quick images.

#include "engine/volume/volume.h"

namespace freevoxels {

/// How voxels without data count in a mean.
enum class WithoutData {
  Zero,     ///< as 0: for densities, where no data means empty space
  Ignored,  ///< not at all: for values that are classified
};

/// A volume whose voxels are the means of blocks of factor³ voxels, at the same place in the world.
/// Temperatures and albedos are means of the voxels that have data.
Volume coarseVolume(const Volume& volume, int factor, WithoutData withoutData);

}  // namespace freevoxels
