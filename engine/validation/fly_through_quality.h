#pragma once
// A flight through a volume against the oracle: pictures from inside, and that nothing pops on the way.

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

/// The cameras of fly_through.h. Checks of the default method: PSNR of every frame, and what of its change
/// from one frame to the next is not the oracle's (RMSE). Beside it, without checks, the table alone and
/// sorted blending.
ReportSection flyThroughQuality(const StageMaker& make, const QualityScene& scene, int frames,
                                int pictureEdge);

/// What of the change from `before` to `after` is not that of the truth: RMSE of premultiplied RGBA.
double wrongChange(const Image& before, const Image& after, const Image& trueBefore, const Image& trueAfter);

}  // namespace freevoxels
