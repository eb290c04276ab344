#pragma once
// Images of volumes with emission compared with the oracle's and with closed forms.

#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Least PSNR of images of a fire, in dB: engine/docs/validation.md, Bounds.
inline constexpr double kFirePsnr = 32.0;

/// The procedural fire at `resolution`³ voxels, with and without its smoke, from several views; and boxes of
/// one temperature.
ReportSection emissionChecks(const Device& device, int resolution, int imageEdge);

}  // namespace freevoxels
