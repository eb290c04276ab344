#include "engine/hierarchy/level_passes.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "embedded/medium_level.h"
#include "embedded/table_level.h"
#include "engine/hierarchy/occupancy.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

static_assert(shader::kFilterGeometric == int(HierarchyFilter::Geometric));
static_assert(shader::kFilterArithmetic == int(HierarchyFilter::Arithmetic));
static_assert(shader::kRowAlignment % 2 == 0);  // two children of a row are in one word of occupancy

shader::MediumLevelPush mediumPush(const DeviceVolume& volume, int level) {
  const int childEdge = Block{.level = level - 1}.edge();
  return {.child = volume.onDevice(level - 1),
          .parent = volume.onDevice(level),
          .stores = volume.stores(),
          .voxels = volume.layout.dimensions,
          .childEdge = childEdge,
          .parentCount = std::uint32_t(volume.stored[std::size_t(level)]),
          .childLength = float(volume.voxelSize * childEdge),
          .firstColor = volume.firstRank(1)};
}

}  // namespace

MediumLevels::MediumLevels(const Device& device, const DeviceVolume& volume) {
  const std::uint32_t colors = volume.hasColors, emission = volume.hasEmission();
  for (const std::uint32_t fromVoxels : {0u, 1u})
    pipelines_[fromVoxels] =
        makeComputePipeline(device, {medium_level_spv, "medium level"},
                            {.bindings = std::vector(2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                             .pushConstantBytes = sizeof(shader::MediumLevelPush)},
                            {shader::kLevelThreads, 1, 1}, {colors, fromVoxels, emission});
}

void MediumLevels::record(Commands& commands, const DeviceVolume& volume,
                          std::span<const VisibleVoxels> coarse) const {
  commands.beginPass("octree");
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    const shader::MediumLevelPush push = mediumPush(volume, level);
    const std::array<Binding, 2> bindings{&volume.occupancy, &coarse[std::size_t(level) - 1].indices};
    commands.dispatchLinear(pipelines_[level == 1 ? 1 : 0], bindings, push, push.parentCount);
    commands.barrier(kCompute, kCompute);
  }
}

TableLevels::TableLevels(const Device& device, const TableSettings& settings)
    : TableLevels(device, settings,
                  device.isCpu() ? shader::kDirectionsPerLevelPass : kDirectionsPerGpuThread) {}

TableLevels::TableLevels(const Device& device, const TableSettings& settings,
                         std::uint32_t directionsPerThread)
    : perThread_(directionsPerThread) {
  std::vector<VkDescriptorType> bindings{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                         VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                         VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
  bindings.insert(bindings.end(), shader::kDirectionsPerLevelPass, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
  bindings.insert(bindings.end(), shader::kDirectionsPerLevelPass, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  for (const std::uint32_t fromVoxels : {0u, 1u})
    pipelines_[fromVoxels] = makeComputePipeline(
        device, {table_level_spv, "table level"},
        {.bindings = bindings, .pushConstantBytes = sizeof(shader::TableLevelPush)},
        {shader::kLevelThreads, 1, 1},
        {std::uint32_t(settings.code), std::uint32_t(settings.filter), fromVoxels, perThread_});
}

void TableLevels::record(Commands& commands, const DeviceVolume& volume,
                         std::span<const VisibleVoxels> coarse, const AttenuationTable& table) const {
  constexpr std::size_t kGroup = shader::kDirectionsPerLevelPass;
  commands.beginPass("octree table");
  commands.clear(table.darkest);
  const std::size_t directions = table.planes.size();
  for (int level = 1; level <= volume.hierarchy.top(); ++level) {
    shader::TableLevelPush push{.child = volume.onDevice(level - 1),
                                .parent = volume.onDevice(level),
                                .voxels = volume.layout.dimensions,
                                .childEdge = Block{.level = level - 1}.edge(),
                                .parentCount = std::uint32_t(volume.stored[std::size_t(level)])};
    for (std::size_t first = 0; first < directions; first += kGroup) {
      push.firstDirection = std::uint32_t(first);
      push.directionCount = std::uint32_t(std::min(kGroup, directions - first));
      std::vector<Binding> bindings{&table.darkest, &volume.occupancyTexels,
                                    &coarse[std::size_t(level) - 1].indices};
      // Whatever is bound in the last group's place of more is not looked at.
      for (std::size_t i = 0; i < kGroup; ++i)
        bindings.emplace_back(&table.planeTexels[std::min(first + i, directions - 1)]);
      for (std::size_t i = 0; i < kGroup; ++i)
        bindings.emplace_back(&table.planes[std::min(first + i, directions - 1)]);
      commands.dispatchLinear(pipelines_[level == 1 ? 1 : 0], bindings, push, boundBytes(push.parentCount),
                              (push.directionCount + perThread_ - 1) / perThread_);
    }
    commands.barrier(kCompute, kCompute);
  }
}

LevelData downloadMedium(const Device& device, const DeviceVolume& volume, int level) {
  const GridLayout& grid = volume.hierarchy.levels[std::size_t(level)];
  const std::vector<std::uint32_t> blocks = downloadStored(device, volume, level);
  const std::uint64_t first = volume.firstRank(level);
  std::vector<float> stored(blocks.size());
  download(device, volume.extinction, std::as_writable_bytes(std::span(stored)), first * sizeof(float));
  const std::vector<float> extinction = spreadOut(stored, blocks, grid.voxels());
  LevelData data{.dimensions = grid.dimensions, .extinction = {extinction.begin(), extinction.end()}};
  if (volume.hasEmission()) {
    std::vector<std::uint32_t> light(blocks.size());
    download(device, volume.emission, std::as_writable_bytes(std::span(light)),
             first * sizeof(std::uint32_t));
    for (const std::uint32_t bits : spreadOut(light, blocks, grid.voxels()))
      data.emission.push_back(volume.emissionUnit * unpackColor(bits));
  }
  if (!volume.hasColors || level == 0) return data;
  std::vector<glm::uvec2> colors(blocks.size());
  download(device, volume.blockColors, std::as_writable_bytes(std::span(colors)),
           (first - volume.firstRank(1)) * sizeof(glm::uvec2));
  for (const glm::uvec2 bits : spreadOut(colors, blocks, grid.voxels()))
    data.colors.emplace_back(glm::unpackHalf2x16(bits.x), glm::unpackHalf2x16(bits.y).x);
  return data;
}

}  // namespace freevoxels
