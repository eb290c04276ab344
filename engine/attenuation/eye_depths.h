#pragma once
// Optical depths from an eye or a light inside the volume to the outside, which look-ups in the table
// subtract: Subr et al. 2007, Section 3.3.

#include "engine/octree/device_volume.h"
#include "engine/scene/directions.h"
#include "engine/scene/source_rays.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

/// COMPUTE eye_depths.comp
class EyeDepthsPass {
 public:
  explicit EyeDepthsPass(const Device& device);
  /// Writes shader::kMaximumCells floats, by cellNumber, into slot `slot` of `depths`.
  void record(Commands& commands, const DeviceVolume& volume, DirectionSet set, const RaySource& source,
              const Buffer& depths, int slot = 0) const;

 private:
  Pipeline pipeline_;
};

inline constexpr VkDeviceSize kEyeDepthsBytes = shader::kMaximumCells * sizeof(float);

}  // namespace freevoxels
