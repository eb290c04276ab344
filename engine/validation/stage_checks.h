#pragma once
// Checks every stage on the device against its double-precision version on the CPU (engine/reference).

#include "engine/validation/report.h"
#include "engine/validation/stage_outputs.h"
#include "engine/validation/validation_scene.h"

namespace freevoxels {

/// Each stage is checked given the device's results of the previous stage, so that an error appears where it
/// is made and nowhere else. Tables are made with all four settings; frames of `size` pixels with the default
/// method in perspective and with the paper's in orthographic projection. Check names begin with the stage:
/// "classify", "table", "visible voxels", "splat sums", "resolve".
ReportSection stageChecks(const StageMaker& make, const ValidationScene& scene, glm::ivec2 size);

}  // namespace freevoxels
