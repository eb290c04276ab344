#pragma once
// The image of the classic sorted splatter, on the CPU in double precision: back-to-front alpha blending,
// Subr et al. 2007, Section 4.1, Eq. 9. Attenuation leaks, because overlapping splats of one layer each
// attenuate independently.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/image/image.h"
#include "engine/reference/reference_light.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// Orders voxels (ascending indices, Volume::at) with the farthest first, by the distance of the centre from
/// the eye (for an orthographic camera along the viewing axis) minus that of the volume's middle. Distances
/// that are equal in single precision keep the order of their indices.
std::vector<std::uint32_t> referenceBackToFront(const Volume& volume, const Camera& camera,
                                                std::span<const std::uint32_t> voxels);

/// Draws the voxels. Image::depth, if requested, is the distance along the viewing axis, blended like the
/// colour and divided by alpha; infinite where alpha is 0. Only the size of `settings` matters. `light`
/// lights the voxels; without it they send out their colour.
Image referenceSortedImage(const Volume& volume, const Classification& classification, const Camera& camera, const FrameSettings& settings,
                           std::span<const std::uint32_t> voxels, const ReferenceLight* light = nullptr);

}  // namespace freevoxels
