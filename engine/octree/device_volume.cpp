#include "engine/octree/device_volume.h"

#include <cstdint>
#include <numeric>

#include "engine/volume/packed_light.h"
#include "shaders/interface.h"

namespace freevoxels {

std::uint64_t DeviceVolume::storedBlocks() const {
  return std::accumulate(stored.begin(), stored.end(), std::uint64_t(0));
}

std::uint32_t DeviceVolume::firstRank(int level) const {
  return std::uint32_t(std::accumulate(stored.begin(), stored.begin() + level, std::uint64_t(0)));
}

std::uint32_t DeviceVolume::firstBound(int level) const {
  std::uint64_t first = storedBlocks();
  for (int below = 1; below < level; ++below) first += boundBytes(stored[std::size_t(below)]);
  return std::uint32_t(first);
}

shader::BlockLevel DeviceVolume::onDevice(int level) const {
  const GridLayout& grid = hierarchy.levels[std::size_t(level)];
  return {.first = hierarchy.first[std::size_t(level)],
          .firstRank = stored.empty() ? 0 : firstRank(level),
          .firstBound = stored.empty() ? 0 : firstBound(level),
          .rowPitch = grid.rowPitch,
          .dimensions = grid.dimensions};
}

shader::BlockStores DeviceVolume::stores() const {
  return {.extinction = addressWords(extinction.address()),
          .emission = addressWords(emission.address()),
          .colors = addressWords(colors.address()),
          .blockColors = addressWords(blockColors.address())};
}

DeviceVolume outlineOnDevice(const Volume& volume, const Classification& classification) {
  return {.layout = GridLayout(volume.dimensions),
          .hierarchy = HierarchyLayout(volume.dimensions),
          .indexToWorld = volume.indexToWorld,
          .albedo = classification.albedo,
          .hasColors = volume.albedo.has_value() || classification.transferFunction.has_value(),
          .emissionUnit = brightestLight(classification, volume) / kBrightest,
          .voxelSize = volume.voxelSize()};
}

DeviceVolume makeDeviceVolume(const Device& device, const Volume& volume,
                              const Classification& classification) {
  DeviceVolume result = outlineOnDevice(volume, classification);
  const std::uint64_t words = result.hierarchy.paddedBlocks() / shader::kBlocksPerWord;
  result.occupancy = Buffer(device, words * sizeof(shader::OccupancyWord), MemoryUse::Device, "occupancy",
                            VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  result.occupancyTexels = TexelView(device, result.occupancy, VK_FORMAT_R32G32_UINT);
  return result;
}

}  // namespace freevoxels
