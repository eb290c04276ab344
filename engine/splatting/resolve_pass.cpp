#include "engine/splatting/resolve_pass.h"

#include <array>
#include <cstdint>

#include "embedded/resolve.h"

namespace freevoxels {

ResolvePass::ResolvePass(const Device& device, bool withDistance)
    : withDistance_(withDistance),
      pipeline_(makeComputePipeline(device, shaders::resolve, {withDistance ? 1u : 0u})) {}

void ResolvePass::record(Commands& commands, const FrameConstants& frame, const FrameTargets& targets) const {
  // Without T or without distances the binding is not read; the other target is bound in its place.
  const std::array<Binding, 3> images{
      &targets.colorEnergy, targets.opticalDepth.exists() ? &targets.opticalDepth : &targets.distance,
      withDistance_ ? &targets.distance : &targets.opticalDepth};
  commands.beginPass("resolve");
  commands.dispatch(pipeline_, images, frame.resolve, {targets.colorEnergy.size(), 1});
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
}

}  // namespace freevoxels
