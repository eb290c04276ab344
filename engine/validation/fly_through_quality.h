#pragma once
// A flight through a volume compared with the oracle: images from inside, and that nothing pops.

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

/// Uses the cameras of fly_through.h. Checks of the default method: PSNR of every frame, and the part of its
/// change from one frame to the next that the oracle does not have (RMSE). Reports the table alone and sorted
/// blending as well, without checks.
ReportSection flyThroughQuality(const StageMaker& make, const QualityScene& scene, int frames, int imageEdge);

/// The part of the change from `before` to `after` that the truth does not have: RMSE of premultiplied RGBA.
double wrongChange(const Image& before, const Image& after, const Image& trueBefore, const Image& trueAfter);

}  // namespace freevoxels
