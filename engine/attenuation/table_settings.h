#pragma once
// How the attenuation table is made.

#include "engine/attenuation/directions.h"

namespace freevoxels {

struct TableSettings {
  AttenuationCode code = AttenuationCode::Depth8;
  bool pathLengthCorrection = true;  ///< off: every layer of voxels is as thick as a voxel, as in the paper
  DirectionSet directions = DirectionSet::Directions26;
};

}  // namespace freevoxels
