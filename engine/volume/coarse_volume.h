#pragma once
// A volume in fewer voxels, for a quick look at it.

#include "engine/volume/volume.h"

namespace freevoxels {

/// What a voxel without data is to a mean.
enum class WithoutData {
  Zero,     ///< of densities: there is nothing there
  Ignored,  ///< of values that are classified: there is no value there
};

/// Blocks of factor³ voxels, each their mean, for voxels, in the same place of the world. Temperatures and
/// albedos are means of what is there.
Volume coarseVolume(const Volume& volume, int factor, WithoutData withoutData);

}  // namespace freevoxels
