#pragma once
// Figures 2, 6 and 7 of Subr et al. 2007, drawn by the device.

#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

/// Figure 2: the attenuation table of a uniform, grey, translucent cube in three directions, as the
/// brightness of its voxels; compared with Beer-Lambert.
ReportSection paperFigure2(const StageMaker& make);

/// Figure 6: a uniform translucent cube of few voxels, blended back to front and as FreeVoxels; and the
/// difference of both opacities from the oracle's.
ReportSection paperFigure6(const StageMaker& make);

/// Figure 7: a head in red light, compared with the oracle; and in white light that becomes red inside it.
ReportSection paperFigure7(const StageMaker& make);

}  // namespace freevoxels
