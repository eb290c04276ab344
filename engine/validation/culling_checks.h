#pragma once
// Checks that culling does not change images: frames with culling are compared with those of everything.

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Largest difference of a pixel and least PSNR in dB with hidden blocks left out at the default threshold;
/// and the largest difference if only what is outside of the image is left out: engine/docs/validation.md, Bounds.
inline constexpr double kCullingDifference = 1e-2, kCullingPsnr = 50.0, kFrustumDifference = 1e-5;

/// Views from far and near, orthographic, from inside and of a small part. Reports how many blocks are
/// considered, empty, outside, hidden, opened and drawn, and the images and place of the largest difference.
ReportSection cullingChecks(const Device& device, const QualityScene& scene, int imageEdge);

}  // namespace freevoxels
