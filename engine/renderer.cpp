#include "engine/renderer.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/renderer_state.h"

namespace freevoxels {

Renderer::Renderer(const Device& device, const Volume& volume, const Classification& classification,
                   const TableSettings& table, const Progress& progress) {
  state_ = std::make_unique<State>(State{
      .device = device, .hostVolume = volume, .classification = classification, .tableSettings = table});
  state_->built = buildVolume(device, volume, classification, state_->buildTimes, progress);
}

Renderer::~Renderer() = default;

Image Renderer::render(const Camera& camera, const FrameSettings& settings, const Progress& progress) {
  checkCamera(camera);
  checkFrameFits(state_->device, settings);
  State& state = *state_;
  state.drawFitting(settings, [&](const FrameSettings& fitting) {
    Commands commands(state.device);
    const std::shared_ptr<const FrameTargets> targets = state.recordImage(commands, camera, fitting, progress);
    commands.beginPass("read back");
    state.colorReadback.record(state.device, commands, targets->colorEnergy);
    if (settings.depth) state.distanceReadback.record(state.device, commands, targets->distance);
    commands.submitAndWait(progress);
    addTimes(state.frameTimes, commands.times());
  });

  const StageTimer timer(state.frameTimes, "copy to host");
  return {.size = settings.size,
          .pixels = state.colorReadback.read<glm::vec4>(),
          .depth = settings.depth ? state.distanceReadback.read<float>() : std::vector<float>()};
}

std::shared_ptr<const FrameTargets> Renderer::renderOnDevice(const Camera& camera, const FrameSettings& settings,
                                                             const Progress& progress) {
  checkCamera(camera);
  checkFrameFits(state_->device, settings);
  return state_->drawFitting(settings, [&](const FrameSettings& fitting) {
    Commands commands(state_->device);
    std::shared_ptr<const FrameTargets> targets = state_->recordImage(commands, camera, fitting, progress);
    commands.submitAndWait(progress);
    addTimes(state_->frameTimes, commands.times());
    return targets;
  });
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

FixedSums Renderer::renderShares(const Camera& camera, const FrameSettings& wanted, const SharePart& part, const Progress& progress) {
  FV_CHECK_EQ(wanted.composite == Composite::Sorted, false);
  FV_CHECK_LT(part.index, part.count);
  FV_CHECK_LE(part.count, kShares);
  checkCamera(camera);
  checkFrameFits(state_->device, wanted);
  State& state = *state_;
  FrameSettings settings = wanted;
  settings.cullThreshold = 0.0f;
  return state.drawFitting(settings, [&](const FrameSettings& fitting) {
    return drawsByGathering(fitting) ? state.gatherShares(camera, fitting, part, progress) : state.splatShares(camera, fitting, part, progress);
  });
}

VolumeMemory Renderer::memory() const {
  return state_->memoryOfVolume();
}

std::vector<StageTime> Renderer::timings() const {
  std::vector<StageTime> times = state_->buildTimes;
  std::ranges::copy(state_->frameTimes, std::back_inserter(times));
  return times;
}

std::optional<std::uint64_t> Renderer::occupiedVoxelCount() const {
  if (!state_->built.hasBlocks()) return {};
  return state_->built.volume.stored.front();
}

bool Renderer::lackedRoomForRays() const {
  return state_->lastLackedRays;
}

bool Renderer::lackedRoomForGather() const {
  return state_->lastLackedGather;
}

CutCounts Renderer::cutCounts() const {
  if (state_->lastDrawn == nullptr) return {};
  if (state_->lastWasCut) return state_->cutter->counts();
  CutCounts counts{.drawn = std::vector<std::uint64_t>(std::size_t(state_->lastLevel), 0)};
  counts.drawn.push_back(downloadBlockCount(state_->device, *state_->lastDrawn));
  counts.considered = counts.drawn.back();
  return counts;
}

}  // namespace freevoxels
