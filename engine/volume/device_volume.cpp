#include "engine/volume/device_volume.h"

#include <cstdint>
#include <numeric>

#include "engine/volume/packed_light.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

void uploadTransferFunction(const Device& device, const Classification& classification,
                            DeviceVolume& target) {
  std::vector<glm::vec4> points;
  if (classification.transferFunction) {
    const TransferFunction& function = *classification.transferFunction;
    for (const auto& point : function.opacity) points.emplace_back(point.scalar, point.opacity, 0.0f, 0.0f);
    for (const auto& point : function.color) points.emplace_back(point.scalar, point.color);
    target.opacityPointCount = std::uint32_t(function.opacity.size());
    target.colorPointCount = std::uint32_t(function.color.size());
  } else {
    points.emplace_back(0.0f);  // a binding needs a buffer
  }
  target.transferPoints =
      Buffer(device, points.size() * sizeof(glm::vec4), MemoryUse::Device, "transfer function");
  upload(device, target.transferPoints, std::as_bytes(std::span(points)));
}

}  // namespace

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

DeviceVolume makeDeviceVolume(const Device& device, const Volume& volume,
                              const Classification& classification) {
  DeviceVolume result{.layout = GridLayout(volume.dimensions),
                      .hierarchy = HierarchyLayout(volume.dimensions),
                      .indexToWorld = volume.indexToWorld,
                      .albedo = classification.albedo,
                      .hasAlbedos = volume.albedo.has_value() && !classification.transferFunction,
                      .emissionUnit = brightestLight(classification, volume) / kBrightest,
                      .voxelSize = volume.voxelSize(),
                      .activeVoxels = volume.activeVoxels};
  if (result.hasEmission()) result.activeVoxels += volume.temperature->activeVoxels;
  const std::uint64_t words = result.hierarchy.paddedBlocks() / shader::kBlocksPerWord;
  result.occupancy = Buffer(device, words * sizeof(shader::OccupancyWord), MemoryUse::Device, "occupancy",
                            VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  result.occupancyTexels = TexelView(device, result.occupancy, VK_FORMAT_R32G32_UINT);
  uploadTransferFunction(device, classification, result);
  return result;
}

}  // namespace freevoxels
