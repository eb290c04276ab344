#include "engine/splatting/frame_targets.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/vulkan/target_readback.h"

namespace freevoxels {

std::vector<const RenderTarget*> FrameTargets::all() const {
  std::vector targets{&colorEnergy};
  if (opticalDepth.exists()) targets.push_back(&opticalDepth);
  if (distance.exists()) targets.push_back(&distance);
  return targets;
}

FrameTargets makeTargets(const Device& device, const FrameSettings& settings, TargetKind kind) {
  FrameTargets targets{
      .colorEnergy = RenderTarget(device, settings.size, kTargetColorFormat, "C and E"), .opticalDepth = {}, .distance = {}};
  if (settings.depth) targets.distance = RenderTarget(device, settings.size, kTargetScalarFormat, "distance");
  if (kind == TargetKind::Sums)
    targets.opticalDepth = RenderTarget(device, settings.size, kTargetScalarFormat, "T");
  return targets;
}

std::shared_ptr<const FrameTargets> TargetPool::take(const Device& device, const FrameSettings& settings, TargetKind kind) {
  const auto isIdle = [](const std::shared_ptr<const FrameTargets>& targets) { return targets.use_count() == 1; };
  const auto suits = [&](const std::shared_ptr<const FrameTargets>& targets) {
    return targets->colorEnergy.size() == settings.size && targets->distance.exists() == settings.depth &&
           targets->opticalDepth.exists() == (kind == TargetKind::Sums);
  };
  std::erase_if(kept_, [&](const auto& targets) { return !suits(targets); });  // before others are allocated
  const auto idle = std::ranges::find_if(kept_, isIdle);
  if (idle != kept_.end()) return *idle;
  return kept_.emplace_back(std::make_shared<const FrameTargets>(makeTargets(device, settings, kind)));
}

std::uint64_t targetBytes(const FrameSettings& settings) {
  const std::uint64_t perPixel =
      bytesPerPixel(kTargetColorFormat) + bytesPerPixel(kTargetScalarFormat) * (settings.depth ? 2 : 1);
  return std::uint64_t(settings.size.x) * std::uint64_t(settings.size.y) * perPixel;
}

void checkFrameFits(const Device& device, const FrameSettings& settings) {
  checkTargetFits(device, settings.size, kTargetColorFormat);
  const std::uint64_t bytes = targetBytes(settings);
  if (bytes > device.memoryBytes())
    fail(ErrorKind::OutOfMemory,
         "an image of {}x{} pixels needs {} MiB of device memory and {} may use {} MiB of it: use a smaller {}",
         settings.size.x, settings.size.y, bytes >> 20, device.description().name,
         device.memoryBytes() >> 20, Parameter("size"));
}

Image downloadImage(const Device& device, const FrameTargets& targets) {
  Commands commands(device);
  TargetReadback color, distance;
  color.record(device, commands, targets.colorEnergy);
  if (targets.distance.exists()) distance.record(device, commands, targets.distance);
  commands.submitAndWait();
  return {.size = targets.colorEnergy.size(),
          .pixels = color.read<glm::vec4>(),
          .depth = targets.distance.exists() ? distance.read<float>() : std::vector<float>()};
}

}  // namespace freevoxels
