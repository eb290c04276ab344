#include "engine/attenuation/ray_sweep.h"

#include <cstdint>

#include "embedded/ray_sweep.h"

namespace freevoxels {

namespace {

std::uint64_t depthBytes(const RayFan& fan) {
  return fan.rays() * std::uint64_t((fan.planeCount + 1) / 2) * sizeof(std::uint32_t);
}

shader::RayFan deviceFan(const RayFan& fan, VkDeviceAddress depths) {
  return {.axis = fan.axis,
          .direction = fan.direction,
          .firstPlane = fan.firstPlane,
          .planeCount = fan.planeCount,
          .rayCount = fan.rayCount,
          .origin = fan.origin,
          .slope = fan.slope,
          .convergence = float(fan.convergence),
          .farthest = float(fan.farthest),
          .spacing = float(fan.spacing),
          .depths = {std::uint32_t(depths), std::uint32_t(depths >> 32)}};
}

}  // namespace

RaySweep::RaySweep(const Device& device)
    : device_(device),
      pipeline_(makeComputePipeline(device, {ray_sweep_spv, "ray sweep"},
                                    {.bindings = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                     .pushConstantBytes = sizeof(shader::RaySweepPush)},
                                    {shader::kRaySweepThreads, 1, 1})) {}

void RaySweep::record(Commands& commands, const DeviceVolume& volume, const RaySource& source) {
  const std::array<RayFan, 6> fans = rayFans(volume.layout.dimensions, source);
  std::uint64_t bytes = 0;
  for (const RayFan& fan : fans) bytes += depthBytes(fan);
  if (depths_.bytes() < bytes) depths_ = Buffer(device_, bytes, MemoryUse::Device, "ray depths");

  commands.beginPass("ray sweep");
  VkDeviceAddress address = depths_.address();
  for (std::size_t i = 0; i < fans.size(); ++i) {
    fans_[i] = deviceFan(fans[i], address);
    if (fans[i].planeCount == 0) continue;
    const shader::RaySweepPush push{.fan = fans_[i],
                                    .indexToWorld = glm::dmat3(volume.indexToWorld),
                                    .dimensions = volume.layout.dimensions,
                                    .rowPitch = volume.layout.rowPitch};
    const std::array<Binding, 1> bindings{&volume.extinction};
    commands.dispatchLinear(pipeline_, bindings, push, fans[i].rays());
    address += depthBytes(fans[i]);
  }
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

}  // namespace freevoxels
