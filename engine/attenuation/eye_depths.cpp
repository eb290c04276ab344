#include "engine/attenuation/eye_depths.h"

#include <array>

#include "embedded/eye_depths.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

EyeDepthsPass::EyeDepthsPass(const Device& device)
    : pipeline_(makeComputePipeline(device, shaders::eye_depths)) {}

void EyeDepthsPass::record(Commands& commands, const DeviceVolume& volume, DirectionSet set,
                           const RaySource& source, const Buffer& depths, int slot) const {
  const glm::dvec3 last(volume.layout.dimensions - 1);
  const shader::EyeDepthsPush push{.voxels = volume.onDevice(0),
                                   .stores = volume.stores(),
                                   .place = glm::clamp(source.place, glm::dvec3(0.0), last),
                                   .cells = int(set),
                                   .first = slot * shader::kMaximumCells};
  const std::array<Binding, 2> bindings{&volume.occupancy, &depths};
  const int edge = 2 * int(set) + 1;
  commands.beginPass("eye depths");
  commands.dispatchLinear(pipeline_, bindings, push, std::uint64_t(edge * edge * edge));
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

}  // namespace freevoxels
