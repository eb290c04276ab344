#include "engine/attenuation/ray_sweep.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "embedded/ray_sweep.h"
#include "engine/core/error.h"

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

std::uint64_t depthBytes(const std::array<RayFan, 6>& fans) {
  std::uint64_t bytes = 0;
  for (const RayFan& fan : fans) bytes += depthBytes(fan);
  return bytes;
}

void checkFits(const Device& device, const std::array<RayFan, 6>& fans, std::uint64_t mostBytes) {
  const std::uint64_t bytes = depthBytes(fans);
  std::uint64_t largest = 0;
  for (const RayFan& fan : fans) largest = std::max(largest, depthBytes(fan));
  // Shaders index the depths of a fan with 31 bits.
  const std::uint64_t most = std::uint64_t(std::numeric_limits<std::int32_t>::max()) * sizeof(std::uint32_t);
  const std::uint64_t fits = std::min(std::uint64_t(device.maximumAllocation()), mostBytes);
  if (bytes > fits || largest > most)
    fail(ExitCode::OutOfMemory,
         "exact transmittance needs {} MiB for its rays from here and {} has {} MiB in one piece: use "
         "--attenuation bilinear, or a smaller volume",
         bytes >> 20, device.description().name, std::min(fits, most) >> 20);
}

}  // namespace

std::uint64_t rayBytes(glm::ivec3 dimensions, const RaySource& source) {
  std::uint64_t bytes = 0;
  for (const RayFan& fan : rayFans(dimensions, source)) bytes += depthBytes(fan);
  return bytes;
}

RaySweep::RaySweep(const Device& device, const char* name)
    : device_(device),
      name_(name),
      pipeline_(makeComputePipeline(device, {ray_sweep_spv, "ray sweep"},
                                    {.bindings = std::vector(2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                                     .pushConstantBytes = sizeof(shader::RaySweepPush)},
                                    {shader::kRaySweepThreads, 1, 1})) {}

void RaySweep::makeRoom(glm::ivec3 dimensions, const RaySource& source, std::uint64_t mostBytes) {
  const std::array<RayFan, 6> fans = rayFans(dimensions, source);
  checkFits(device_, fans, std::min(mostBytes, device_.availableBytes() + depths_.bytes()));
  const std::uint64_t bytes = depthBytes(fans);
  if (depths_.bytes() >= bytes) return;
  depths_ = {};  // not both at once
  depths_ = Buffer(device_, bytes, MemoryUse::Device, "ray depths");
}

void RaySweep::record(Commands& commands, const DeviceVolume& volume, const RaySource& source) {
  const std::array<RayFan, 6> fans = rayFans(volume.layout.dimensions, source);
  makeRoom(volume.layout.dimensions, source);

  commands.beginPass(name_);
  VkDeviceAddress address = depths_.address();
  for (std::size_t i = 0; i < fans.size(); ++i) {
    fans_[i] = deviceFan(fans[i], address);
    if (fans[i].planeCount == 0) continue;
    const shader::RaySweepPush push{
        .fan = fans_[i], .indexToWorld = glm::dmat3(volume.indexToWorld), .voxels = volume.onDevice(0)};
    const std::array<Binding, 2> bindings{&volume.occupancy, &volume.extinction};
    commands.dispatchLinear(pipeline_, bindings, push, fans[i].rays());
    address += depthBytes(fans[i]);
    if (source.atInfinity) {
      fans_.fill(fans_[i]);
      break;
    }
  }
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

RayCodes RaySweep::sweep(const DeviceVolume& volume, const RaySource& source) {
  Commands commands(device_);
  record(commands, volume, source);
  commands.submitAndWait();
  const std::array<RayFan, 6> fans = rayFans(volume.layout.dimensions, source);
  RayCodes codes;
  std::uint64_t first = 0;
  for (std::size_t f = 0; f < fans.size(); ++f) {
    const std::uint64_t rays = fans[f].rays();
    std::vector<std::uint32_t> pairs(depthBytes(fans[f]) / sizeof(std::uint32_t));
    if (pairs.empty()) continue;
    download(device_, depths_, std::as_writable_bytes(std::span(pairs)), first);
    first += depthBytes(fans[f]);
    codes[f].resize(rays * std::uint64_t(fans[f].planeCount));
    for (std::uint64_t i = 0; i < codes[f].size(); ++i) {
      const std::uint64_t plane = i / rays;
      codes[f][i] = std::uint16_t(pairs[plane / 2 * rays + i % rays] >> (plane % 2 * 16));
    }
  }
  return codes;
}

}  // namespace freevoxels
