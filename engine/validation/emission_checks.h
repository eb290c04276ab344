#pragma once
// How near pictures of what sends out light are to the oracle's, and to closed forms.

#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// What pictures of a fire have to reach, in dB.
inline constexpr double kFirePsnr = 32.0;

/// The procedural fire at `resolution`³ voxels, with its smoke and without, from a few views; and boxes of
/// one temperature.
ReportSection emissionChecks(const Device& device, int resolution, int pictureEdge);

}  // namespace freevoxels
