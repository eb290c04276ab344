#pragma once
// From the sums of a frame to its image. Additive: Subr et al. 2007, Eq. 10 and 11; normalised: resolve.comp.

#include "engine/splatting/splat_pass.h"

namespace freevoxels {

/// COMPUTE resolve.comp, in place: colorEnergy becomes premultiplied RGBA, distance the mean distance. Not
/// needed for a sorted frame without distances.
class ResolvePass {
 public:
  ResolvePass(const Device& device, bool withDistance);
  void record(Commands& commands, const FrameConstants& frame, const FrameTargets& targets) const;

 private:
  bool withDistance_;
  Pipeline pipeline_;
};

}  // namespace freevoxels
