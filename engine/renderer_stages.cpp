#include "engine/renderer_stages.h"

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/renderer_state.h"

namespace freevoxels {

RendererStages::RendererStages(const Renderer& renderer)
    : state_(renderer.state_
                 ? *renderer.state_
                 : throw Error(ErrorKind::OutOfMemory, fmt::format("the volume is not on the device as a whole, where its table and its "
                                                                   "blocks are looked at: draw a frame first, or raise {}",
                                                                   Parameter("memory-limit")))) {}

std::vector<SplatSums> RendererStages::renderSums(const Camera& camera, const FrameSettings& settings) const {
  FV_CHECK_EQ(settings.composite == Composite::Sorted, false);
  checkCamera(camera);
  checkFrameFits(state_.device, settings);
  Commands commands(state_.device);
  FrameSettings whole = settings;
  whole.cullThreshold = 0.0f;
  const Renderer::State::Splatting frame = state_.recordSplats(commands, camera, whole);
  commands.beginPass("read back");
  const SumsReadback sums(state_.device, commands, *frame.targets);
  commands.submitAndWait();
  addTimes(state_.frameTimes, commands.times());
  return sums.read(frame.constants);
}

void RendererStages::clearGather() const {
  if (!state_.gather) return;
  Commands clearing(state_.device);
  state_.gather->recordClear(clearing);
  clearing.submitAndWait();
}

std::vector<GatherSums> RendererStages::marchListed(const Camera& camera, const FrameSettings& settings,
                                                    std::span<const std::uint32_t> places) const {
  clearGather();
  const Renderer::State::Gathering frame = state_.prepareGather(camera, settings, {});
  Commands commands(state_.device);
  state_.gather->begin(commands, frame.lattice);
  state_.gather->recordListed(commands, *state_.gatherVolume, frame.lattice, places);
  commands.submitAndWait();
  return state_.gather->downloadGathered();
}

GatherStages RendererStages::renderGatherStages(const Camera& camera, const FrameSettings& settings) const {
  FV_CHECK_EQ(int(settings.draw), int(Draw::Gather));
  checkCamera(camera);
  checkFrameFits(state_.device, settings);
  clearGather();
  Commands commands(state_.device);
  const std::shared_ptr<const FrameTargets> targets = state_.recordImage(commands, camera, settings, {});
  commands.submitAndWait();
  addTimes(state_.frameTimes, commands.times());
  GatherStages stages = downloadGatherStages(state_.device, state_.built, *state_.gatherVolume, *state_.gather);
  stages.image = downloadImage(state_.device, *targets);
  return stages;
}

std::vector<float> RendererStages::downloadExtinction() const {
  const LevelData voxels = downloadMedium(state_.device, state_.builtWithBlocks().volume, 0);
  return {voxels.extinction.begin(), voxels.extinction.end()};
}

std::vector<glm::dvec3> RendererStages::downloadEmission() const {
  return downloadMedium(state_.device, state_.builtWithBlocks().volume, 0).emission;
}

std::vector<std::vector<std::uint8_t>> RendererStages::downloadTable() const {
  return freevoxels::downloadTable(state_.device, state_.builtWithBlocks().volume, state_.sweptTable());
}

RayCodes RendererStages::downloadRays(const Camera& camera) const {
  RaySweep sweep(state_.device);
  return sweep.sweep(state_.builtWithBlocks().volume, eyeSource(camera, state_.built.volume.indexToWorld));
}

std::vector<Block> RendererStages::downloadDrawnBlocks() const {
  std::vector<Block> blocks;
  if (state_.lastDrawn == nullptr) return blocks;
  for (const std::uint32_t index : freevoxels::downloadBlockList(state_.device, *state_.lastDrawn))
    blocks.push_back(state_.built.volume.hierarchy.blockAt(index));
  return blocks;
}

std::vector<LevelData> RendererStages::downloadLevels() const {
  const AttenuationTable& table = state_.tableWithLevels();
  std::vector<LevelData> levels;
  for (int level = 1; level <= state_.built.volume.hierarchy.top(); ++level) {
    LevelData data = downloadMedium(state_.device, state_.built.volume, level);
    data.table = freevoxels::downloadTable(state_.device, state_.built.volume, table, level);
    data.bounds = downloadBounds(state_.device, state_.built.volume, table, level);
    levels.push_back(std::move(data));
  }
  return levels;
}

std::vector<std::uint32_t> RendererStages::downloadBlockList() const {
  std::vector<std::uint32_t> voxels =
      freevoxels::downloadBlockList(state_.device, state_.builtWithBlocks().visible);
  for (std::uint32_t& voxel : voxels) voxel = state_.built.volume.layout.unpaddedIndex(voxel);
  return voxels;
}

}  // namespace freevoxels
