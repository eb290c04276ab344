#pragma once
// How the attenuation table is made.

#include "engine/scene/directions.h"

namespace freevoxels {

/// What a block of the octree has of its children's attenuations: Subr et al. 2007, Section 3.2.
enum class HierarchyFilter : int {
  Geometric = 0,   ///< the geometric mean of transmittances, that is the mean of optical depths: Eq. 7
  Arithmetic = 1,  ///< the mean of transmittances, to compare with
};

struct TableSettings {
  AttenuationCode code = AttenuationCode::Depth8;
  bool pathLengthCorrection = true;  ///< off: every layer of voxels is as thick as a voxel, as in the paper
  DirectionSet directions = DirectionSet::Directions26;
  HierarchyFilter filter = HierarchyFilter::Geometric;
};

}  // namespace freevoxels
