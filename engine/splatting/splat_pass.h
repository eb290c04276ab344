#pragma once
// From voxels and blocks to the sums of a frame: set-up and blended drawing of splats. Subr et al. 2007,
// Section 3.3 and 4.1.

#include <array>
#include <cstdint>
#include <functional>

#include "engine/attenuation/attenuation_table.h"
#include "engine/attenuation/eye_depths.h"
#include "engine/octree/block_list.h"
#include "engine/octree/device_volume.h"
#include "engine/splatting/frame_constants.h"
#include "engine/splatting/frame_targets.h"

namespace freevoxels {

/// COMPUTE eye_depths.comp if the table is looked up from inside; then COMPUTE splat_setup.comp and GRAPHICS splat.vert + splat.frag,
/// chunk by chunk. Leaves the targets in layout GENERAL, visible to compute.
class SplatPass {
 public:
  /// All frames must be of the same volume.
  SplatPass(const Device& device, bool withDistance, bool sorted = false);

  struct Inputs {
    const DeviceVolume& volume;
    const AttenuationTable* table;                 ///< null if FrameConstants::readsTable is false
    const BlockList* visible;                  ///< the blocks to draw, by FrameConstants::detail
    std::uint32_t firstChunk = 0, chunkCount = 0;  ///< the chunks of `visible` to draw
    /// Whether the call before was of the same frame, whose constants the pass has, and the targets, in layout GENERAL, hold its sums.
    bool continued = false;
    const Buffer* lights = nullptr;  ///< shader::Light of each light; only with lighting
    const Buffer* order = nullptr;   ///< the occupied voxels in the order to draw them; null for the order of the list
    /// Called where a chunk's splats are set up, with their buffer of shader::Splat and the chunk; may be empty.
    std::function<void(const Buffer& splats, std::uint32_t chunk)> onSplats;
  };
  void record(Commands& commands, const Inputs& inputs, const FrameConstants& frame, const FrameTargets& targets);
  /// Whether the pass is made for such frames.
  bool draws(const FrameSettings& settings) const { return withDistance_ == settings.depth && sorted_ == settings.isSorted(); }

 private:
  void recordFrame(Commands& commands, const DeviceVolume& volume, const FrameConstants& frame);
  void beginRendering(Commands& commands, const FrameTargets& targets, const FrameConstants& frame, VkAttachmentLoadOp load) const;

  const Device& device_;
  bool withDistance_, sorted_;
  /// Pipelines for frames without lighting, with lighting, and with tinted lighting, each made when it is
  /// first needed.
  std::array<Pipeline, 3> setups_;
  Pipeline points_, quads_;
  EyeDepthsPass eyeDepthsPass_;
  Buffer frame_;      ///< shader::SetupFrame
  Buffer eyeDepths_;  ///< output of EyeDepthsPass
  Buffer splats_;     ///< shader::Splat for each splat of a chunk
};

}  // namespace freevoxels
