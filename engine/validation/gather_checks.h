#pragma once
// The gather, stage by stage, against engine/reference/reference_gather.h.

#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"
#include "engine/validation/validation_scene.h"

namespace freevoxels {

/// Frames of the scene without lights, `size` pixels each: blocks as they are stored, sums of the lattice's samples, sums after
/// the stencil, and the image, each against a reference that is given what the stage before it made. With a transfer function
/// both classified before and after interpolation.
ReportSection gatherChecks(const StageMaker& make, const ValidationScene& scene, glm::ivec2 size);

}  // namespace freevoxels
