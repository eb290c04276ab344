#include "engine/octree/block_list.h"

#include <algorithm>
#include <array>
#include <span>

#include "embedded/compact_count.h"
#include "embedded/compact_scan.h"
#include "embedded/compact_write.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

std::uint32_t groupsFor(std::uint32_t words) {
  return (words + shader::kOccupancyThreads - 1) / shader::kOccupancyThreads;
}

shader::CompactPush pushOf(const DeviceVolume& volume, int level) {
  const auto words = std::uint32_t(volume.hierarchy.words(level));
  return {.firstWord = volume.hierarchy.first[std::size_t(level)] / shader::kBlocksPerWord,
          .wordCount = words,
          .groupCount = groupsFor(words)};
}

std::uint64_t threadsOf(const shader::CompactPush& push) {
  return std::uint64_t(push.groupCount) * shader::kOccupancyThreads;
}

/// Where BlockList::groupOffsets has the number of a level's occupied blocks, in bytes.
VkDeviceSize totalAt(const shader::CompactPush& push) {
  return VkDeviceSize(push.groupCount) * sizeof(std::uint32_t);
}

}  // namespace

shader::ChunkArguments drawArguments(std::uint32_t first, std::uint32_t count) {
  return {.groupsX = (count + shader::kSplatThreads - 1) / shader::kSplatThreads,
          .groupsY = 1,
          .groupsZ = 1,
          .splatCount = count,
          .firstSplat = first,
          .vertexCount = count,
          .instanceCount = 1,
          .quadVertexCount = 4,
          .quadInstanceCount = count};
}

CompactionPass::CompactionPass(const Device& device)
    : device_(device),
      count_(makeComputePipeline(device, shaders::compact_count)),
      scan_(makeComputePipeline(device, shaders::compact_scan)),
      write_(makeComputePipeline(device, shaders::compact_write)) {}

void CompactionPass::recordCounts(Commands& commands, const DeviceVolume& volume, std::span<BlockList* const> levels,
                                  const Buffer& totals) const {
  commands.beginPass("block lists");
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const shader::CompactPush push = pushOf(volume, int(level));
    Buffer& offsets = levels[level]->groupOffsets;
    if (offsets.bytes() == 0) offsets = Buffer(device_, totalAt(push) + sizeof(std::uint32_t), MemoryUse::Device, "block group offsets");
    const std::array<Binding, 2> bindings{&volume.occupancy, &offsets};
    commands.dispatchLinear(count_, bindings, push, threadsOf(push));
  }
  commands.barrier(kComputeStage, kComputeStage);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const std::array<Binding, 2> bindings{&levels[level]->groupOffsets, &totals};  // of no chunks, so that the second is not written
    commands.dispatchLinear(scan_, bindings, pushOf(volume, int(level)), shader::kScanThreads);
  }
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_TRANSFER_BIT);
  for (std::size_t level = 0; level < levels.size(); ++level)
    commands.copy(levels[level]->groupOffsets, totals,
                  {.srcOffset = totalAt(pushOf(volume, int(level))),
                   .dstOffset = VkDeviceSize(level) * sizeof(std::uint32_t),
                   .size = sizeof(std::uint32_t)});
}

void CompactionPass::allocate(BlockList& list, std::uint64_t count) const {
  std::vector<shader::ChunkArguments> chunks;
  for (std::uint64_t first = 0; first == 0 || first < count; first += shader::kSplatsPerChunk)
    chunks.push_back(
        drawArguments(std::uint32_t(first), std::uint32_t(std::min<std::uint64_t>(count - first, shader::kSplatsPerChunk))));
  list.chunkCount = std::uint32_t(chunks.size());
  list.indices =
      Buffer(device_, std::max<std::uint64_t>(count, 1) * sizeof(std::uint32_t), MemoryUse::Device, "occupied blocks");
  list.chunks = Buffer(device_, chunks.size() * sizeof(shader::ChunkArguments), MemoryUse::Device, "chunk arguments",
                       VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  upload(device_, list.chunks, std::as_bytes(std::span(chunks)));
}

void CompactionPass::recordLists(Commands& commands, const DeviceVolume& volume, std::span<BlockList* const> levels) const {
  commands.beginPass("block lists");
  for (std::size_t level = 0; level < levels.size(); ++level) {
    shader::CompactPush push = pushOf(volume, int(level));
    push.blocks = addressWords(levels[level]->indices.address());
    const std::array<Binding, 2> bindings{&volume.occupancy, &levels[level]->groupOffsets};
    commands.dispatchLinear(write_, bindings, push, threadsOf(push));
  }
  commands.barrier(kComputeStage, kComputeStage);
}

std::uint64_t downloadBlockCount(const Device& device, const BlockList& list) {
  std::vector<shader::ChunkArguments> chunks(list.chunkCount);
  download(device, list.chunks, std::as_writable_bytes(std::span(chunks)));
  std::uint64_t total = 0;
  for (const shader::ChunkArguments& chunk : chunks) total += chunk.splatCount;
  return total;
}

std::vector<std::uint32_t> downloadBlockList(const Device& device, const BlockList& list) {
  std::vector<std::uint32_t> indices(downloadBlockCount(device, list));
  download(device, list.indices, std::as_writable_bytes(std::span(indices)));
  return indices;
}

}  // namespace freevoxels
