#pragma once
// How near lit pictures are to the oracle's, and whether shadows are where they should be.

#include <span>

#include "engine/validation/quality_scenes.h"
#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// What lit pictures of volumes without parts of the size of a voxel have to reach, in dB: shadowed by the
/// table, and exactly; and lit by a sky.
inline constexpr double kTableLightPsnr = 32.0, kExactLightPsnr = 38.0, kEnvironmentPsnr = 42.0;

/// One light from the side, from a few views.
ReportSection lightQuality(const Device& device, const QualityScene& scene, int pictureEdge);

/// Mean over the views, and the worst of them, of what is lit and opaque.
inline constexpr double kOpaqueMeanPsnr = 35.0, kOpaqueWorstPsnr = 32.0;

/// One and three lights with exact shadows on what is opaque within a few voxels.
ReportSection opaqueLightQuality(const Device& device, const QualityScene& scene, std::span<const QualityView> views,
                                 int pictureEdge);

/// A sky with a sun, from one view: the oracle marches for it from every point of the volume.
ReportSection environmentQuality(const Device& device, const QualityScene& scene, int pictureEdge);

/// The shadow of a small opaque ball in thin fog, which 26 directions draw as a star, and the light within an
/// opaque hollow ball, where there is none; in volumes of `resolution`³ voxels.
ReportSection shadowChecks(const Device& device, int resolution);

}  // namespace freevoxels
