#include "engine/validation/stepped_renderer.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/octree/volume_builder.h"
#include "engine/splatting/sums_readback.h"

namespace freevoxels {

namespace {

/// The arguments that compact_scan.comp writes for a list of `count` voxels.
std::vector<shader::ChunkArguments> chunkArguments(std::size_t count, std::uint32_t chunks) {
  std::vector<shader::ChunkArguments> arguments;
  for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
    const std::size_t first = std::min(count, std::size_t(chunk) * shader::kSplatsPerChunk);
    const auto splats = std::uint32_t(std::min<std::size_t>(count - first, shader::kSplatsPerChunk));
    arguments.push_back({.groupsX = (splats + shader::kSplatThreads - 1) / shader::kSplatThreads,
                         .groupsY = 1,
                         .groupsZ = 1,
                         .splatCount = splats,
                         .firstSplat = chunk * shader::kSplatsPerChunk,
                         .vertexCount = splats,
                         .instanceCount = 1,
                         .quadVertexCount = 4,
                         .quadInstanceCount = splats});
  }
  return arguments;
}

}  // namespace

SteppedVolume prepareSteps(const Device& device, const Volume& volume, const Classification& classification,
                           const TableSettings& table) {
  std::vector<StageTime> times;
  BuiltVolume built = buildVolume(device, volume, classification, times);
  if (!built.hasBlocks()) buildBlocks(device, volume, classification, built, times);
  SteppedVolume steps{.volume = std::move(built.volume), .visible = std::move(built.visible)};
  steps.table = makeTable(device, steps.volume, table);
  AttenuationSweep sweep(device, table);
  Commands commands(device);
  sweep.record(commands, steps.volume, steps.table);
  commands.submitAndWait();
  steps.voxels = downloadBlockList(device, steps.visible);
  return steps;
}

std::vector<std::vector<std::uint8_t>> sweepThinSlabs(const Device& device, const SteppedVolume& steps) {
  const TableSettings& settings = steps.table.settings;
  SweepStyle style = sweepStyle(device);
  style.mostSlabBytes = 0;
  AttenuationSweep sweep(device, settings, style);
  const AttenuationTable table = makeTable(device, steps.volume, settings);
  Commands commands(device);
  sweep.record(commands, steps.volume, table);
  commands.submitAndWait();
  return downloadTable(device, steps.volume, table);
}

std::vector<SplatSums> drawVoxels(const Device& device, const SteppedVolume& steps,
                                  std::span<const std::uint32_t> voxels, const Camera& camera,
                                  const FrameSettings& settings) {
  FV_CHECK_LE(voxels.size_bytes(), steps.visible.indices.bytes());
  const auto chunks = chunkArguments(voxels.size(), steps.visible.chunkCount);
  if (!voxels.empty()) upload(device, steps.visible.indices, std::as_bytes(voxels));
  upload(device, steps.visible.chunks, std::as_bytes(std::span(chunks)));

  const FrameConstants frame =
      makeFrameConstants(device, steps.volume, steps.table.settings, camera, settings);
  const FrameTargets targets = makeTargets(device, settings, TargetKind::Sums);
  SplatPass splats(device, settings.depth);
  Commands commands(device);
  splats.record(commands,
                {.volume = steps.volume,
                 .table = &steps.table,
                 .visible = &steps.visible,
                 .chunkCount = steps.visible.chunkCount},
                frame, targets);
  const SumsReadback sums(device, commands, targets);
  commands.submitAndWait();
  return sums.read(frame);
}

}  // namespace freevoxels
