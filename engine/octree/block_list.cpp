#include "engine/octree/block_list.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "embedded/compact_count.h"
#include "embedded/compact_scan.h"
#include "embedded/compact_write.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

std::uint32_t groupsFor(std::uint32_t words) {
  return (words + shader::kOccupancyThreads - 1) / shader::kOccupancyThreads;
}

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;

Pipeline makePass(const Device& device, ShaderCode code, std::vector<VkDescriptorType> bindings,
                  int threads) {
  return makeComputePipeline(
      device, code, {.bindings = std::move(bindings), .pushConstantBytes = sizeof(shader::CompactPush)},
      {threads, 1, 1});
}

}  // namespace

BlockList makeBlockList(const Device& device, const DeviceVolume& volume, int level) {
  BlockList result;
  const GridLayout& layout = volume.hierarchy.levels[std::size_t(level)];
  const std::uint64_t most = std::clamp<std::uint64_t>(volume.activeVoxels, 1, layout.voxels());
  result.chunkCount = std::uint32_t((most + shader::kSplatsPerChunk - 1) / shader::kSplatsPerChunk);
  result.groupOffsets =
      Buffer(device, (groupsFor(std::uint32_t(volume.hierarchy.words(level))) + 1) * sizeof(std::uint32_t),
             MemoryUse::Device, "visible group offsets");
  result.indices = Buffer(device, most * sizeof(std::uint32_t), MemoryUse::Device, "visible voxels");
  result.chunks = Buffer(device, result.chunkCount * sizeof(shader::ChunkArguments), MemoryUse::Device,
                         "chunk arguments", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  return result;
}

CompactionPass::CompactionPass(const Device& device)
    : count_(makePass(device, {compact_count_spv, "visible count"}, {kStorage, kStorage},
                      shader::kOccupancyThreads)),
      scan_(makePass(device, {compact_scan_spv, "visible scan"}, {kStorage, kStorage}, shader::kScanThreads)),
      write_(makePass(device, {compact_write_spv, "visible write"}, {kStorage, kStorage},
                      shader::kOccupancyThreads)) {}

void CompactionPass::record(Commands& commands, const DeviceVolume& volume, const BlockList& visible,
                            int level) const {
  const auto words = std::uint32_t(volume.hierarchy.words(level)), groups = groupsFor(words);
  const shader::CompactPush push{
      .firstWord = volume.hierarchy.first[std::size_t(level)] / shader::kBlocksPerWord,
      .wordCount = words,
      .groupCount = groups,
      .chunkCount = visible.chunkCount,
      .blocks = addressWords(visible.indices.address())};
  const std::array<Binding, 2> count{&volume.occupancy, &visible.groupOffsets};
  const std::array<Binding, 2> scan{&visible.groupOffsets, &visible.chunks};
  const std::array<Binding, 2> write{&volume.occupancy, &visible.groupOffsets};
  constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  const std::uint64_t threads = std::uint64_t(groups) * shader::kOccupancyThreads;
  commands.beginPass("visible voxels");
  commands.dispatchLinear(count_, count, push, threads);
  commands.barrier(kCompute, kCompute);
  commands.dispatchLinear(scan_, scan, push, shader::kScanThreads);
  commands.barrier(kCompute, kCompute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
  commands.dispatchLinear(write_, write, push, threads);
  commands.barrier(kCompute, kCompute);
}

std::uint64_t downloadBlockCount(const Device& device, const BlockList& visible) {
  std::vector<shader::ChunkArguments> chunks(visible.chunkCount);
  download(device, visible.chunks, std::as_writable_bytes(std::span(chunks)));
  std::uint64_t total = 0;
  for (const shader::ChunkArguments& chunk : chunks) total += chunk.splatCount;
  return total;
}

std::vector<std::uint32_t> downloadBlockList(const Device& device, const BlockList& visible) {
  std::vector<std::uint32_t> voxels(downloadBlockCount(device, visible));
  download(device, visible.indices, std::as_writable_bytes(std::span(voxels)));
  return voxels;
}

}  // namespace freevoxels
