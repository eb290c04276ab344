#pragma once
// Checks of what must not change results: the order of the voxels, their grouping, the slabs of the sweeps,
// repetition, and the axes along which the field is stored.

#include "engine/validation/report.h"
#include "engine/validation/validation_scene.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// `size` is that of the frames in pixels.
ReportSection invariances(const Device& device, const ValidationScene& scene, glm::ivec2 size);

}  // namespace freevoxels
