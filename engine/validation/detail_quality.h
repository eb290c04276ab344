#pragma once
// What pictures lose by the level of detail, and whether a zoom shows it.

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Pictures at the default level of detail against those of all voxels, where voxels are 1/2, 1/4 and 1/8
/// pixel wide.
ReportSection detailQuality(const Device& device, const QualityScene& scene);

/// How much a zoom from far to near changes from frame to frame beyond what it does with all voxels.
ReportSection zoomQuality(const Device& device, const QualityScene& scene);

}  // namespace freevoxels
