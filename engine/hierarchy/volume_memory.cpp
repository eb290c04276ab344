#include "engine/hierarchy/volume_memory.h"

#include <numeric>
#include <vector>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Bytes of the largest buffer that the passes can bind, of which they may see a texel every `texelBytes`.
std::uint64_t largestBinding(const Device& device, std::uint64_t texelBytes) {
  return std::min({std::uint64_t(device.limits().maxStorageBufferRange),
                   std::uint64_t(device.limits().maxTexelBufferElements) * texelBytes,
                   std::uint64_t(device.maximumAllocation())});
}

void checkBinds(const Device& device, glm::ivec3 box, std::uint64_t bytes, std::uint64_t texelBytes) {
  const std::uint64_t most = largestBinding(device, texelBytes);
  if (bytes > most)
    fail(ExitCode::OutOfMemory,
         "a volume of {}x{}x{} voxels needs a buffer of {} MiB and {} binds at most {} MiB: crop or resample "
         "it",
         box.x, box.y, box.z, bytes >> 20, device.description().name, most >> 20);
}

void checkHolds(const Device& device, glm::ivec3 box, const VolumeMemory& memory, const char* mend) {
  if (memory.peak() > device.description().memoryBytes)
    fail(ExitCode::OutOfMemory,
         "a volume of {}x{}x{} voxels needs {} MiB of device memory and {} has {} MiB: crop or resample it{}",
         box.x, box.y, box.z, memory.peak() >> 20, device.description().name,
         device.description().memoryBytes >> 20, mend);
}

/// Of a box that holds nothing.
VolumeMemory emptyMemory(const HierarchyLayout& hierarchy) {
  return volumeMemory(hierarchy, std::vector<std::uint64_t>(hierarchy.levels.size(), 0),
                      DirectionSet::Directions26, false);
}

}  // namespace

VolumeMemory volumeMemory(const HierarchyLayout& hierarchy, std::span<const std::uint64_t> stored,
                          DirectionSet directions, bool colors) {
  const std::uint64_t blocks = std::accumulate(stored.begin(), stored.end(), std::uint64_t(0));
  const std::uint64_t voxels = stored.front(), coarse = blocks - voxels;
  return {.occupancy = hierarchy.paddedBlocks() / shader::kBlocksPerWord * sizeof(shader::OccupancyWord),
          .extinction = blocks * sizeof(float),
          .table = (blocks + coarse) * std::uint64_t(directionCount(directions)),
          .colors = colors ? voxels * sizeof(float) + coarse * sizeof(glm::uvec2) : 0,
          // Of all blocks and of those of a frame, with a bit for each that could be one and two bytes for
          // each that has children.
          .lists = (blocks + voxels) * sizeof(std::uint32_t) + blocks + 2 * coarse,
          .dense = hierarchy.denseVoxels() * 2 * sizeof(float)};
}

std::uint64_t maximumVoxels(const Device& device) {
  const HierarchyLayout cube(glm::ivec3(1024));
  const VolumeMemory memory = emptyMemory(cube);
  const auto voxels = double(cube.levels.front().voxels());
  return std::uint64_t(
      std::min(double(largestBinding(device, sizeof(glm::vec4))) * (voxels / double(memory.dense / 2)),
               double(device.description().memoryBytes) * (voxels / double(memory.peak()))));
}

void checkBoxFits(const Device& device, const HierarchyLayout& hierarchy) {
  const VolumeMemory memory = emptyMemory(hierarchy);
  const glm::ivec3 box = hierarchy.levels.front().dimensions;
  checkBinds(device, box, memory.dense / 2, sizeof(glm::vec4));
  checkHolds(device, box, memory, "");
}

void checkStoresFit(const Device& device, const DeviceVolume& volume) {
  checkBinds(device, volume.layout.dimensions, volume.storedBlocks() * sizeof(float), sizeof(glm::vec4));
}

void checkTableFits(const Device& device, const DeviceVolume& volume, DirectionSet directions) {
  const glm::ivec3 box = volume.layout.dimensions;
  checkBinds(device, box, volume.planeBytes(), 1);
  checkHolds(device, box, volumeMemory(volume.hierarchy, volume.stored, directions, volume.hasColors()),
             directions == DirectionSet::Directions26 ? "" : ", or take 26 directions");
}

}  // namespace freevoxels
