#include "engine/attenuation/table_levels.h"

#include <algorithm>
#include <vector>

#include "embedded/table_level.h"

namespace freevoxels {

namespace {

static_assert(shader::kFilterGeometric == int(HierarchyFilter::Geometric));
static_assert(shader::kFilterArithmetic == int(HierarchyFilter::Arithmetic));

}  // namespace

TableLevels::TableLevels(const Device& device, const TableSettings& settings)
    : TableLevels(device, settings,
                  device.isCpu() ? shader::kDirectionsPerLevelPass : kDirectionsPerGpuThread) {}

TableLevels::TableLevels(const Device& device, const TableSettings& settings,
                         std::uint32_t directionsPerThread)
    : perThread_(directionsPerThread) {
  for (const std::uint32_t fromVoxels : {0u, 1u})
    pipelines_[fromVoxels] = makeComputePipeline(device, shaders::table_level, {std::uint32_t(settings.code), std::uint32_t(settings.filter), fromVoxels, perThread_});
}

void TableLevels::record(Commands& commands, const DeviceVolume& volume,
                         std::span<const BlockList> coarse, const AttenuationTable& table) const {
  constexpr std::size_t kGroup = shader::kDirectionsPerLevelPass;
  commands.beginPass("octree table");
  commands.clear(table.maxCodePerDirection);
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
      std::vector<Binding> bindings{&table.maxCodePerDirection, &volume.occupancyTexels,
                                    &coarse[std::size_t(level) - 1].indices};
      // The last group may have fewer directions. Its other bindings are not read.
      for (std::size_t i = 0; i < kGroup; ++i)
        bindings.emplace_back(&table.planeTexels[std::min(first + i, directions - 1)]);
      for (std::size_t i = 0; i < kGroup; ++i)
        bindings.emplace_back(&table.planes[std::min(first + i, directions - 1)]);
      commands.dispatchLinear(pipelines_[level == 1 ? 1 : 0], bindings, push, boundBytes(push.parentCount),
                              (push.directionCount + perThread_ - 1) / perThread_);
    }
    commands.barrier(kComputeStage, kComputeStage);
  }
}

}  // namespace freevoxels
