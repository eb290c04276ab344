#pragma once
// Checks of the device by closed forms.

#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

/// Beer-Lambert in all 26 directions and in images of a homogeneous cube of `edge` voxels, the integral of a
/// single voxel, the empty volume, and the two voxels p and q of Subr et al. 2007, Section 4.1, Eq. 8 to 10.
/// Below an edge of 32 voxels footprints are too large in relation to the cube.
ReportSection closedForms(const StageMaker& make, int edge);

}  // namespace freevoxels
