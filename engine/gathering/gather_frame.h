#pragma once
// The lattice of samples of a gathered frame and their rays.

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "engine/octree/device_volume.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/visibility/detail_rule.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

/// The lattice and the rays of a frame, computed in double precision on the host. The caller fills in the
/// levels: from `finest`, which may be one below the rule's, to `coarsest`. Rays end at the transmittance
/// `endTransmittance`.
shader::GatherFrame makeGatherFrame(const DeviceVolume& volume, const Camera& camera, const FrameSettings& settings,
                                    const DetailRule& detail, double endTransmittance);

/// The weight of stretches of scalars in four parts, where rays of this direction in index space are seen in the middle of the image: 1
/// along the diagonals of a voxel and of its faces, where samples lie at the same places of all voxels, and 0 away from them.
double quartersOf(glm::dvec3 direction);

/// Gives frames of several volumes, with the same camera and settings, one lattice, fine enough for each, and the rectangles that are seen
/// of all.
void shareLattice(std::span<shader::GatherFrame> frames, const FrameSettings& settings);

/// Whether some ray of the lattice may march along this axis.
bool someRayHasAxis(const shader::GatherFrame& frame, int axis);

/// A rectangle of samples of a lattice.
struct SampleRectangle {
  glm::ivec2 first{0}, extent{0};
};
/// The samples of a frame of `volume` whose rays may meet what is interpolated of the voxels from `begin` to `end` - 1; nothing if there
/// are none.
std::optional<SampleRectangle> samplesThatSee(const DeviceVolume& volume, const Camera& camera, const shader::GatherFrame& frame,
                                              glm::ivec3 begin, glm::ivec3 end);

}  // namespace freevoxels
