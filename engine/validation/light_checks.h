#pragma once
// Lit images compared with the oracle's, and the place of shadows.

#include <span>

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Least PSNR in dB of lit images of volumes without structures of the size of a voxel: with shadows of the
/// table, with exact shadows, and lit by a sky: engine/docs/validation.md, Bounds.
inline constexpr double kTableLightPsnr = 32.0, kExactLightPsnr = 38.0, kEnvironmentPsnr = 42.0;

/// One light from the side, in several views.
ReportSection lightQuality(const Device& device, const QualityScene& scene, int imageEdge);

/// Least mean over the views, and least worst view, of opaque lit volumes.
inline constexpr double kOpaqueMeanPsnr = 35.0, kOpaqueWorstPsnr = 32.0;

/// One and three lights with exact shadows on volumes that become opaque within a few voxels.
ReportSection opaqueLightQuality(const Device& device, const QualityScene& scene, std::span<const QualityView> views, int imageEdge);

/// A sky with a sun, in one view: the oracle marches towards it from every point of the volume.
ReportSection environmentQuality(const Device& device, const QualityScene& scene, int imageEdge);

/// The shadow of a small opaque ball in thin fog, which 26 directions draw as a star, and the light inside an
/// opaque hollow ball, where there is none; in volumes of `resolution`³ voxels.
ReportSection shadowChecks(const Device& device, int resolution);

}  // namespace freevoxels
