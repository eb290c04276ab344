#include "engine/hierarchy/occupancy.h"

#include <array>
#include <bit>

#include "embedded/expand_voxels.h"
#include "embedded/occupied_blocks.h"
#include "embedded/occupied_voxels.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;

}  // namespace

OccupancyPass::OccupancyPass(const Device& device)
    : voxels_(makeComputePipeline(
          device, {occupied_voxels_spv, "occupied voxels"},
          {.bindings = {kTexels, kStorage}, .pushConstantBytes = sizeof(shader::VoxelsPush)},
          {shader::kOccupancyThreads, 1, 1})),
      blocks_(makeComputePipeline(
          device, {occupied_blocks_spv, "occupied blocks"},
          {.bindings = {kStorage}, .pushConstantBytes = sizeof(shader::OccupiedBlocksPush)},
          {shader::kOccupancyThreads, 1, 1})) {}

void OccupancyPass::record(Commands& commands, const DeviceVolume& volume, const DenseVoxels& voxels) const {
  const std::array<Binding, 2> bindings{&voxels.extinctionQuads, &volume.occupancy};
  const shader::VoxelsPush words{.count = std::uint32_t(volume.hierarchy.words(0))};
  commands.beginPass("occupancy");
  commands.dispatchLinear(voxels_, bindings, words, words.count);
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    commands.barrier(kCompute, kCompute);
    const shader::OccupiedBlocksPush push{.child = volume.onDevice(level - 1),
                                          .parent = volume.onDevice(level),
                                          .wordCount = std::uint32_t(volume.hierarchy.words(level))};
    const std::array<Binding, 1> occupancy{&volume.occupancy};
    commands.dispatchLinear(blocks_, occupancy, push, push.wordCount);
  }
  commands.barrier(kCompute, kCompute);
}

ExpandPass::ExpandPass(const Device& device)
    : pipeline_(makeComputePipeline(
          device, {expand_voxels_spv, "expand voxels"},
          {.bindings = {kStorage, kStorage, kStorage}, .pushConstantBytes = sizeof(shader::VoxelsPush)},
          {shader::kOccupancyThreads, 1, 1})) {}

void ExpandPass::record(Commands& commands, const DeviceVolume& volume, const Buffer& extinction) const {
  const std::array<Binding, 3> bindings{&volume.occupancy, &volume.extinction, &extinction};
  const shader::VoxelsPush words{.count = std::uint32_t(volume.hierarchy.words(0))};
  commands.dispatchLinear(pipeline_, bindings, words, words.count);
  commands.barrier(kCompute, kCompute);
}

std::vector<std::uint32_t> downloadStored(const Device& device, const DeviceVolume& volume, int level) {
  const std::uint32_t first = volume.hierarchy.first[std::size_t(level)];
  std::vector<shader::OccupancyWord> words(volume.hierarchy.words(level));
  download(device, volume.occupancy, std::as_writable_bytes(std::span(words)),
           first / shader::kBlocksPerWord * sizeof(shader::OccupancyWord));
  const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
  std::vector<std::uint32_t> blocks;
  for (std::size_t word = 0; word < words.size(); ++word)
    for (std::uint32_t mask = words[word].mask; mask != 0; mask &= mask - 1)
      blocks.push_back(grid.unpaddedIndex(std::uint32_t(word) * shader::kBlocksPerWord +
                                          std::uint32_t(std::countr_zero(mask))));
  return blocks;
}

}  // namespace freevoxels
