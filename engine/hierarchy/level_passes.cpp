#include "engine/hierarchy/level_passes.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <iterator>

#include "embedded/medium_level.h"
#include "embedded/table_level.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr const char* kPassName = "octree levels";

static_assert(shader::kFilterGeometric == int(HierarchyFilter::Geometric));
static_assert(shader::kFilterArithmetic == int(HierarchyFilter::Arithmetic));
static_assert(shader::kRowAlignment % 16 == 0);  // a texel of codes is of one row

shader::MediumLevelPush mediumPush(const DeviceVolume& volume, int level) {
  const HierarchyLayout& hierarchy = volume.hierarchy;
  const int childEdge = Block{.level = level - 1}.edge();
  return {.child = hierarchy.onDevice(level - 1),
          .parent = hierarchy.onDevice(level),
          .voxels = volume.layout.dimensions,
          .childEdge = childEdge,
          .parentCount = std::uint32_t(hierarchy.levels[std::size_t(level)].paddedVoxels()),
          .childLength = float(volume.voxelSize * childEdge),
          .firstColor = hierarchy.first[1],
          .opacityPoints = volume.opacityPointCount,
          .colorPoints = volume.colorPointCount};
}

}  // namespace

MediumLevels::MediumLevels(const Device& device, const DeviceVolume& volume) {
  const auto colors = std::uint32_t(volume.blockColors.bytes() > 0);
  for (const std::uint32_t fromVoxels : {0u, 1u})
    pipelines_[fromVoxels] =
        makeComputePipeline(device, {medium_level_spv, "medium level"},
                            {.bindings = std::vector(4, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                             .pushConstantBytes = sizeof(shader::MediumLevelPush)},
                            {shader::kLevelThreads, 1, 1}, {colors, fromVoxels});
}

void MediumLevels::record(Commands& commands, const DeviceVolume& volume) const {
  const Buffer& anyBuffer = volume.transferPoints;
  const std::array<Binding, 4> bindings{&volume.extinction, &volume.transferPoints, &volume.scalars,
                                        volume.blockColors.bytes() > 0 ? &volume.blockColors : &anyBuffer};
  commands.beginPass(kPassName);
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    const shader::MediumLevelPush push = mediumPush(volume, level);
    commands.dispatchLinear(pipelines_[level == 1 ? 1 : 0], bindings, push, push.parentCount);
    commands.barrier(kCompute, kCompute);
  }
}

TableLevels::TableLevels(const Device& device, const TableSettings& settings) {
  for (const std::uint32_t fromVoxels : {0u, 1u})
    pipelines_[fromVoxels] = makeComputePipeline(
        device, {table_level_spv, "table level"},
        {.bindings = {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
         .pushConstantBytes = sizeof(shader::TableLevelPush)},
        {shader::kLevelThreads, 1, 1},
        {std::uint32_t(settings.code), std::uint32_t(settings.filter), fromVoxels});
}

void TableLevels::record(Commands& commands, const DeviceVolume& volume,
                         const AttenuationTable& table) const {
  const HierarchyLayout& hierarchy = volume.hierarchy;
  commands.beginPass(kPassName);
  commands.clear(table.darkest);
  for (int level = 1; level <= hierarchy.top(); ++level) {
    const std::uint64_t blocks = hierarchy.levels[std::size_t(level)].paddedVoxels();
    shader::TableLevelPush push{.child = hierarchy.onDevice(level - 1),
                                .parent = hierarchy.onDevice(level),
                                .voxels = volume.layout.dimensions,
                                .childEdge = Block{.level = level - 1}.edge(),
                                .threadCount = std::uint32_t(blocks / shader::kLevelBlocksPerThread),
                                .boundsOffset = hierarchy.boundsOffset()};
    for (std::size_t direction = 0; direction < table.planes.size(); ++direction) {
      const std::array<Binding, 3> bindings{&table.planeTexels[direction], &table.planes[direction],
                                            &table.darkest};
      push.direction = std::uint32_t(direction);
      commands.dispatchLinear(pipelines_[level == 1 ? 1 : 0], bindings, push, push.threadCount);
    }
    commands.barrier(kCompute, kCompute);
  }
}

LevelLists makeMediumLevels(const Device& device, const DeviceVolume& volume, const VisibleVoxels& voxels,
                            std::vector<StageTime>& times) {
  LevelLists lists;
  const MediumLevels medium(device, volume);
  const CompactionPass compaction(device);
  Commands commands(device);
  medium.record(commands, volume);
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    lists.coarse.push_back(makeVisibleVoxels(device, volume, level));
    compaction.record(commands, volume, lists.coarse.back(), level);
  }
  commands.submitAndWait();
  std::ranges::copy(commands.times(), std::back_inserter(times));
  lists.counts.push_back(downloadVisibleCount(device, voxels));
  for (const VisibleVoxels& level : lists.coarse) lists.counts.push_back(downloadVisibleCount(device, level));
  return lists;
}

LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level) {
  const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
  const std::uint64_t first = volume.hierarchy.first[std::size_t(level)];
  std::vector<float> extinction(grid.paddedVoxels());
  download(device, volume.extinction, std::as_writable_bytes(std::span(extinction)), first * sizeof(float));
  extinction = grid.withoutPadding(extinction);
  LevelData data{.dimensions = grid.dimensions, .extinction = {extinction.begin(), extinction.end()}};
  if (volume.blockColors.bytes() == 0) return data;
  std::vector<glm::uvec2> colors(grid.paddedVoxels());
  download(device, volume.blockColors, std::as_writable_bytes(std::span(colors)),
           (first - volume.hierarchy.first[1]) * sizeof(glm::uvec2));
  for (const glm::uvec2 bits : grid.withoutPadding(colors))
    data.colors.emplace_back(glm::unpackHalf2x16(bits.x), glm::unpackHalf2x16(bits.y).x);
  return data;
}

}  // namespace freevoxels
