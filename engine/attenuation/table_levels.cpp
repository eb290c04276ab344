#include "engine/attenuation/table_levels.h"

#include <algorithm>
#include <vector>

#include "embedded/table_level.h"
#include "embedded/table_level_joined.h"

namespace freevoxels {

namespace {

static_assert(shader::kFilterGeometric == int(HierarchyFilter::Geometric));
static_assert(shader::kFilterArithmetic == int(HierarchyFilter::Arithmetic));
static_assert(shader::kRowAlignment % 2 == 0);  // two children in a row are in the same occupancy word

}  // namespace

TableLevels::TableLevels(const Device& device, const TableSettings& settings)
    : TableLevels(device, settings, device.isCpu() ? shader::kDirectionsPerLevelPass : kDirectionsPerGpuThread, levelDispatches(device)) {}

TableLevels::TableLevels(const Device& device, const TableSettings& settings, std::uint32_t directionsPerThread, LevelDispatches dispatches)
    : perThread_(directionsPerThread), pipelines_{.dispatches = dispatches} {
  const auto pipeline = [&](const Shader& shader, bool fromVoxels) {
    return makeComputePipeline(device, shader, {std::uint32_t(settings.code), std::uint32_t(settings.filter), fromVoxels, perThread_});
  };
  pipelines_.fromVoxels = pipeline(shaders::table_level, true);
  pipelines_.fromBlocks = pipeline(shaders::table_level, false);
  if (dispatches == LevelDispatches::Joined) pipelines_.joined = pipeline(shaders::table_level_joined, false);
}

void TableLevels::record(Commands& commands, const DeviceVolume& volume, const Buffer& steps, const AttenuationTable& table) const {
  commands.beginPass("octree table");
  commands.clear(table.maxCodePerDirection);
  for (const shader::LevelRange levels : levelRanges(volume.hierarchy, pipelines_.dispatches)) {
    for (std::size_t first = 0; first < table.planes.size(); first += shader::kDirectionsPerLevelPass)
      recordDirections(commands, volume, steps, table, levels, first);
    commands.barrier(kComputeStage, kComputeStage);
  }
}

void TableLevels::recordDirections(Commands& commands, const DeviceVolume& volume, const Buffer& steps, const AttenuationTable& table,
                                   shader::LevelRange levels, std::size_t first) const {
  constexpr std::size_t kGroup = shader::kDirectionsPerLevelPass;
  const std::size_t directions = table.planes.size();
  const shader::TableLevelPush push{.levels = levels,
                                    .voxels = volume.layout.dimensions,
                                    .firstDirection = std::uint32_t(first),
                                    .directionCount = std::uint32_t(std::min(kGroup, directions - first))};
  std::vector<Binding> bindings{&table.maxCodePerDirection, &volume.occupancyTexels, &steps};
  // The last group may have fewer directions. Its other bindings are not read.
  for (std::size_t i = 0; i < kGroup; ++i) bindings.emplace_back(&table.planeTexels[std::min(first + i, directions - 1)]);
  for (std::size_t i = 0; i < kGroup; ++i) bindings.emplace_back(&table.planes[std::min(first + i, directions - 1)]);
  commands.dispatchLinear(pipelines_.of(levels), bindings, push,
                          LevelPipelines::threads(levels, boundBytes(volume.stored[std::size_t(levels.first)])),
                          (push.directionCount + perThread_ - 1) / perThread_);
}

}  // namespace freevoxels
