#pragma once
// How much quality the level of detail costs, and whether a zoom shows steps.

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Images at the default level of detail against those of all voxels, with voxels that are 1/2, 1/4 and 1/8
/// pixel wide.
ReportSection detailQuality(const Device& device, const QualityScene& scene);

/// Measures by how much the change from frame to frame in a zoom exceeds that with all voxels.
ReportSection zoomQuality(const Device& device, const QualityScene& scene);

}  // namespace freevoxels
