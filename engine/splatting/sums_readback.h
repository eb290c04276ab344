#pragma once
// Reads the sums of a frame back to the host.

#include <optional>
#include <vector>

#include "engine/splatting/splat_pass.h"
#include "engine/splatting/splat_sums.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

/// Copies a frame's sums to the host: recorded after SplatPass instead of the resolve, read after the
/// commands are complete.
class SumsReadback {
 public:
  SumsReadback(const Device& device, Commands& commands, const FrameTargets& targets);
  /// The sums of every pixel, top row first. `distance` is 0 if the targets have none.
  std::vector<SplatSums> read(const FrameConstants& frame) const;

 private:
  TargetReadback colorEnergy_, opticalDepth_;
  std::optional<TargetReadback> distance_;
};

}  // namespace freevoxels
