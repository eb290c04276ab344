#pragma once
// What a frame leaves out must not show: pictures with culling against those of everything.

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// The most that a pixel may differ, and the least PSNR in dB, with what is hidden left out at the default
/// threshold; and the most where only what is outside of the image is.
inline constexpr double kCullingDifference = 1e-2, kCullingPsnr = 50.0, kFrustumDifference = 1e-5;

/// From far and near, orthographic, from inside and of a small part; how many blocks are considered, empty,
/// outside, hidden, opened and drawn; the pictures of the view that differs most, and where.
ReportSection cullingChecks(const Device& device, const QualityScene& scene, int pictureEdge);

}  // namespace freevoxels
