#pragma once
// What must not change the outcome: the order of the voxels, how they are grouped, the slabs of the sweeps,
// running again, the axes that the field is stored along.

#include "engine/validation/report.h"
#include "engine/validation/validation_scene.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Frames have `size` pixels.
ReportSection invariances(const Device& device, const ValidationScene& scene, glm::ivec2 size);

}  // namespace freevoxels
