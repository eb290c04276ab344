#pragma once
// How the attenuation table is made.

#include "engine/attenuation/directions.h"

namespace freevoxels {

struct TableSettings {
  AttenuationCode code = AttenuationCode::Depth8;
  bool pathLengthCorrection = true;  ///< off: every lattice step has the length of a voxel, as in the paper
};

}  // namespace freevoxels
