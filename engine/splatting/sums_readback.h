#pragma once
// The sums of a frame on the host.

#include <optional>
#include <vector>

#include "engine/splatting/splat_pass.h"
#include "engine/splatting/splat_sums.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

/// Copies a frame's sums to the host: recorded after SplatPass in place of the resolve, read when the
/// commands are done.
class SumsReadback {
 public:
  SumsReadback(const Device& device, Commands& commands, const SplatTargets& targets);
  /// One a pixel, row 0 is the top. `distance` stays 0 where the targets have none.
  std::vector<SplatSums> read(const FrameConstants& frame) const;

 private:
  TargetReadback colorEnergy_, opticalDepth_;
  std::optional<TargetReadback> distance_;
};

}  // namespace freevoxels
