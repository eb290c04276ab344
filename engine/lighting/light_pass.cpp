#include "engine/lighting/light_pass.h"

#include <algorithm>
#include <span>

namespace freevoxels {

namespace {

glm::uvec2 halves(VkDeviceAddress address) {
  return {std::uint32_t(address), std::uint32_t(address >> 32)};
}

shader::Light deviceLight(const Light& light, const RaySource& source, glm::dvec3 middle) {
  const glm::dvec3 size = glm::abs(source.place);
  return {
      .place = light.atInfinity ? source.place / std::max({size.x, size.y, size.z}) : source.place - middle,
      .atInfinity = light.atInfinity ? 1 : 0,
      .color = light.intensity * light.color,
      .beyond = {0, 0}};
}

}  // namespace

std::vector<shader::Light> LightPass::place(const DeviceVolume& volume, DirectionSet set,
                                            std::vector<StageTime>& times) {
  const glm::ivec3 dimensions = volume.layout.dimensions;
  const auto isWithin = [&](const Light& light) {
    return isInside(lightSource(light, volume.indexToWorld), dimensions);
  };
  const auto inside = std::size_t(std::ranges::count_if(*placed_, isWithin));
  beyondDepths_ = {};
  if (inside > 0)
    beyondDepths_ = Buffer(device_, inside * kEyeDepthsBytes, MemoryUse::Device, "depths beyond lights");

  Commands commands(device_);
  std::vector<shader::Light> lights;
  int slot = 0;
  for (const Light& light : *placed_) {
    const RaySource source = lightSource(light, volume.indexToWorld);
    lights.push_back(deviceLight(light, source, 0.5 * glm::dvec3(dimensions - 1)));
    if (!isWithin(light)) continue;
    beyond_.record(commands, volume, set, source, beyondDepths_, slot);
    lights.back().beyond = halves(beyondDepths_.address() + VkDeviceSize(slot++) * kEyeDepthsBytes);
  }
  commands.submitAndWait();
  std::ranges::copy(commands.times(), std::back_inserter(times));
  return lights;
}

shader::FrameLighting LightPass::prepare(const DeviceVolume& volume, const TableSettings& table,
                                         const FrameSettings& settings, std::vector<StageTime>& times) {
  const Lighting& lighting = *settings.lighting;
  const DirectionSet set = table.directions;
  if (placed_ != lighting.lights) {
    placed_ = lighting.lights;
    const std::vector<shader::Light> lights = place(volume, set, times);
    const auto bytes = std::as_bytes(std::span(lights));
    lights_ = Buffer(device_, std::max<VkDeviceSize>(bytes.size(), 4), MemoryUse::Device, "lights");
    upload(device_, lights_, bytes);
  }
  if (shares_.empty()) shares_ = directionShares(set, volume.indexToWorld);
  shader::FrameLighting frame{.lightCount = int(lighting.lights.size()),
                              .lookup = settings.attenuation == AttenuationLookup::Nearest
                                            ? shader::kLookupNearest
                                            : shader::kLookupBilinear,
                              .ambient = lighting.ambient,
                              .phaseG = float(lighting.phaseG)};
  for (int i = 0; i < directionCount(set); ++i)
    frame.shares[cellNumber(set, directionCell(set, i))] = float(shares_[std::size_t(i)]);
  return frame;
}

}  // namespace freevoxels
