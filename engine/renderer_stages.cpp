#include "engine/renderer_stages.h"

#include <cstring>

#include "engine/attenuation/ray_sweep.h"
#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/octree/block_list.h"
#include "engine/renderer_state.h"
#include "engine/splatting/sums_readback.h"

namespace freevoxels {

RendererStages::RendererStages(const Renderer& renderer)
    : state_(renderer.state_
                 ? *renderer.state_
                 : throw Error(ErrorKind::OutOfMemory, fmt::format("the volume is not on the device as a whole, where its table and its "
                                                                   "blocks are looked at: draw a frame first, or raise {}",
                                                                   Parameter("memory-limit")))) {}

std::vector<SplatSums> RendererStages::renderSums(const Camera& camera, const FrameSettings& settings) const {
  FV_CHECK_EQ(settings.gathers() || settings.isSorted(), false);
  checkFrameFits(state_.scene.device, settings);
  Commands commands(state_.scene.device);
  FrameSettings whole = settings;
  whole.splats().cullThreshold = 0.0f;
  const SplatDrawing::Frame frame = state_.splats.prepare(camera, whole, {});
  state_.splats.recordSums(commands, frame);
  commands.beginPass("read back");
  const SumsReadback sums(state_.scene.device, commands, *frame.targets);
  state_.submit(commands);
  return sums.read(frame.constants);
}

/// Sets the sums that an earlier frame left to 0, so that samples that this frame leaves out are noticed.
void RendererStages::clearGather(const Camera& camera, const FrameSettings& settings) const {
  const GatherDrawing::Frame frame = state_.gather.prepare(camera, settings, {});
  Commands clearing(state_.scene.device);
  state_.gather.pass().recordClear(clearing, frame.lattice);
  clearing.submitAndWait();
}

std::vector<GatherSums> RendererStages::marchListed(const Camera& camera, const FrameSettings& settings,
                                                    std::span<const std::uint32_t> places) const {
  const Device& device = state_.scene.device;
  const GatherDrawing::Frame frame = state_.gather.prepare(camera, settings, {});
  constexpr std::size_t kGroup = shader::kGatherTile * shader::kGatherTile;
  const auto groups = std::uint32_t((places.size() + kGroup - 1) / kGroup);
  FV_CHECK_LE(groups, device.limits().maxComputeWorkGroupCount[1]);
  shader::SampleListHead head{.ranges = {}, .count = std::uint32_t(places.size())};
  head.ranges[0] = {.x = 1, .y = groups, .z = 1};
  const Buffer list(device, sizeof(head) + places.size_bytes(), MemoryUse::Upload, "listed samples", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  std::memcpy(list.mapped(), &head, sizeof(head));
  std::memcpy(list.mapped() + sizeof(head), places.data(), places.size_bytes());

  Commands commands(device);
  GatherPass& pass = state_.gather.pass();
  pass.begin(commands, frame.lattice);
  pass.recordClear(commands, frame.lattice);
  pass.dispatch(commands, state_.gather.volume(), frame.lattice, {.frame = &pass.frameBuffer(), .arguments = &list, .mostGroups = groups},
                {.list = addressWords(list.address()), .step = 0, .groupsOfARow = 1, .rowsOfARange = int(groups)});
  commands.submitAndWait();
  return pass.downloadGathered();
}

GatherStages RendererStages::renderGatherStages(const Camera& camera, const FrameSettings& settings) const {
  FV_CHECK_EQ(settings.gathers(), true);
  checkFrameFits(state_.scene.device, settings);
  clearGather(camera, settings);
  Commands commands(state_.scene.device);
  const std::shared_ptr<const FrameTargets> targets = state_.record(commands, camera, settings, {});
  state_.submit(commands);
  GatherStages stages = downloadGatherStages(state_.scene.device, state_.scene.built, state_.gather.volume(), state_.gather.pass());
  stages.image = downloadImage(state_.scene.device, *targets);
  return stages;
}

std::vector<float> RendererStages::downloadExtinction() const {
  const LevelData voxels = downloadMedium(state_.scene.device, state_.scene.builtWithBlocks().volume, 0);
  return {voxels.extinction.begin(), voxels.extinction.end()};
}

std::vector<glm::dvec3> RendererStages::downloadEmission() const {
  return downloadMedium(state_.scene.device, state_.scene.builtWithBlocks().volume, 0).emission;
}

std::optional<ScatteredField> RendererStages::downloadScattered() const {
  const ScatteringSolver* const solver = state_.scene.scattered();
  return solver != nullptr ? std::optional(solver->download()) : std::nullopt;
}

std::vector<std::vector<std::uint8_t>> RendererStages::downloadTable() const {
  return freevoxels::downloadTable(state_.scene.device, state_.scene.builtWithBlocks().volume, state_.scene.table(false));
}

RayCodes RendererStages::downloadRays(const RaySource& source) const {
  RaySweep sweep(state_.scene.device);
  return sweep.sweep(state_.scene.builtWithBlocks().volume, source);
}

std::vector<Block> RendererStages::downloadDrawnBlocks() const {
  std::vector<Block> blocks;
  if (state_.splats.drawnBlocks() == nullptr) return blocks;
  for (const std::uint32_t index : freevoxels::downloadBlockList(state_.scene.device, *state_.splats.drawnBlocks()))
    blocks.push_back(state_.scene.built.volume.hierarchy.blockAt(index));
  return blocks;
}

std::vector<LevelData> RendererStages::downloadLevels() const {
  const AttenuationTable& table = state_.scene.table(true);
  const DeviceVolume& volume = state_.scene.built.volume;
  std::vector<LevelData> levels;
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    LevelData data = downloadMedium(state_.scene.device, volume, level);
    data.table = freevoxels::downloadTable(state_.scene.device, volume, table, level);
    data.bounds = downloadBounds(state_.scene.device, volume, table, level);
    levels.push_back(std::move(data));
  }
  return levels;
}

std::vector<std::uint32_t> RendererStages::downloadBlockList() const {
  std::vector<std::uint32_t> voxels = freevoxels::downloadBlockList(state_.scene.device, state_.scene.builtWithBlocks().visible);
  for (std::uint32_t& voxel : voxels) voxel = state_.scene.built.volume.layout.unpaddedIndex(voxel);
  return voxels;
}

}  // namespace freevoxels
