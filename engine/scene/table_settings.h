#pragma once
// Settings of the attenuation table.

#include "engine/scene/directions.h"

namespace freevoxels {

/// How a block's attenuation is computed from its children's: Subr et al. 2007, Section 3.2.
enum class HierarchyFilter : int {
  Geometric = 0,   ///< the geometric mean of transmittances, that is the mean of optical depths: Eq. 7
  Arithmetic = 1,  ///< the mean of transmittances, for comparison
};

struct TableSettings {
  AttenuationCode code = AttenuationCode::Depth8;
  bool pathLengthCorrection = true;  ///< if false, every layer of voxels is as thick as a voxel, as in the paper
  DirectionSet directions = DirectionSet::Directions26;
  HierarchyFilter filter = HierarchyFilter::Geometric;
};

}  // namespace freevoxels
