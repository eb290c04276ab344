#pragma once
// The picture of the classic sorted splatter, on the CPU in double precision: back-to-front alpha blending,
// Subr et al. 2007, Section 4.1, Eq. 9. Attenuation leaks: splats that share a layer each attenuate what is
// behind by themselves.

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

/// The voxels (indices into Volume::values, ascending), farthest first: by the distance of the centre from
/// the eye, for an orthographic camera along the viewing axis, less that of the volume's middle. Distances
/// that are the same in single precision tie and keep the order of their indices.
std::vector<std::uint32_t> referenceBackToFront(const Volume& volume, const Camera& camera,
                                                std::span<const std::uint32_t> voxels);

/// Image::depth, where asked for, is the distance along the viewing axis blended like the colour, over alpha;
/// infinite where alpha is 0. `settings` give the size; composite and attenuation do not matter. Lit by
/// `light`, or each voxel its colour.
Image referenceSortedPicture(const Volume& volume, const Classification& classification, const Camera& camera,
                             const FrameSettings& settings, std::span<const std::uint32_t> voxels,
                             const ReferenceLight* light = nullptr);

}  // namespace freevoxels
