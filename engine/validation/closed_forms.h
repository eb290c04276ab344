#pragma once
// What the device makes of volumes whose answer can be written down.

#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

/// Beer-Lambert in all 26 directions and in pictures of a homogeneous cube of `edge` voxels, the integral of
/// a single voxel, the empty volume, and the two voxels p and q of Subr et al. 2007, Section 4.1, Eq. 8 to
/// 10. Footprints are too large beside a cube of less than 32 voxels.
ReportSection closedForms(const StageMaker& make, int edge);

}  // namespace freevoxels
