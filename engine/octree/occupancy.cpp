#include "engine/octree/occupancy.h"

#include <array>
#include <bit>

#include "embedded/expand_voxels.h"
#include "embedded/occupied_blocks.h"
#include "embedded/occupied_blocks_joined.h"
#include "embedded/occupied_voxels.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kQuad = 4;  // number of voxels of a row that an invocation of expand_voxels.comp writes

}  // namespace

OccupancyPass::OccupancyPass(const Device& device, bool emission, LevelDispatches dispatches)
    : voxels_(makeComputePipeline(device, shaders::occupied_voxels, {emission ? 1u : 0u})), blocks_{.dispatches = dispatches} {
  blocks_.fromVoxels = blocks_.fromBlocks = makeComputePipeline(device, shaders::occupied_blocks);
  if (dispatches == LevelDispatches::Joined) blocks_.joined = makeComputePipeline(device, shaders::occupied_blocks_joined);
}

void OccupancyPass::recordVoxels(Commands& commands, const DeviceVolume& volume, const DeviceBricks& bricks,
                                 bool first) const {
  commands.beginPass("occupancy");
  if (first) commands.clear(volume.occupancy);
  const std::array<Binding, 4> bindings{&bricks.scalars(), &bricks.firstVoxels(), &bricks.emissions(), &volume.occupancy};
  const shader::BricksPush push = bricks.push();
  commands.dispatchLinear(voxels_, bindings, push, std::uint64_t(push.brickCount) * shader::kBrickThreads);
  commands.barrier(kComputeStage, kComputeStage);
}

void OccupancyPass::recordBlocks(Commands& commands, const DeviceVolume& volume, const Buffer& steps) const {
  commands.beginPass("occupancy");
  for (const shader::LevelRange levels : levelRanges(volume.hierarchy, blocks_.dispatches)) {
    const std::array<Binding, 2> bindings{&volume.occupancy, &steps};
    commands.dispatchLinear(blocks_.of(levels), bindings, shader::OccupiedBlocksPush{levels},
                            LevelPipelines::threads(levels, volume.hierarchy.words(levels.first)));
    commands.barrier(kComputeStage, kComputeStage);
  }
}

ExpandPass::ExpandPass(const Device& device)
    : pipeline_(makeComputePipeline(device, shaders::expand_voxels)) {}

std::uint32_t ExpandPass::record(Commands& commands, const DeviceVolume& volume, int first, int planes,
                                 const Buffer& extinction) const {
  const GridLayout& grid = volume.layout;
  recordBox(commands, volume, {0, 0, first}, {grid.rowPitch, grid.dimensions.y, planes}, extinction);
  return volume.hierarchy.indexOf({.level = 0, .cell = {0, 0, first}});
}

void ExpandPass::recordBox(Commands& commands, const DeviceVolume& volume, glm::ivec3 first,
                           glm::ivec3 extent, const Buffer& extinction) const {
  FV_CHECK_EQ(first.x % kQuad, 0);
  FV_CHECK_EQ(extent.x % kQuad, 0);
  FV_CHECK_LE(glm::u64vec3(extent).x * glm::u64vec3(extent).y * glm::u64vec3(extent).z * sizeof(float),
              extinction.bytes());
  const glm::ivec3 quads(extent.x / kQuad, extent.y, extent.z);
  const shader::ExpandPush push{.voxels = volume.onDevice(0), .first = first, .extent = quads};
  const std::array<Binding, 3> bindings{&volume.occupancyTexels, &volume.extinctionQuads, &extinction};
  commands.dispatch(pipeline_, bindings, push, quads);
  commands.barrier(kComputeStage, kComputeStage);
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
