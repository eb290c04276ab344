#include "engine/octree/volume_limits.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/octree/device_bricks.h"

namespace freevoxels {

std::uint64_t occupancyBytes(const HierarchyLayout& hierarchy) {
  return hierarchy.paddedBlocks() / shader::kBlocksPerWord * sizeof(shader::OccupancyWord);
}

std::uint64_t brickBytes(glm::ivec3 box) {
  const glm::u64vec3 cells((box + 2 * (ScalarBricks::kEdge - 1)) / ScalarBricks::kEdge);
  return std::min<std::uint64_t>(cells.x * cells.y * cells.z * sizeof(ScalarBricks::Brick), kBatchBytes);
}

void checkBinds(const Device& device, glm::ivec3 box, std::uint64_t bytes, std::uint64_t texelBytes) {
  const std::uint64_t most = device.largestBinding(texelBytes);
  if (bytes > most)
    fail(ErrorKind::OutOfMemory,
         "a volume of {}x{}x{} voxels needs a buffer of {} MiB and {} binds at most {} MiB: crop or resample "
         "it, or draw it without the attenuation table ({}, no ambient light)",
         box.x, box.y, box.z, bytes >> 20, device.description().name, most >> 20, Parameter("draw", "gather"));
}

void checkHolds(const Device& device, glm::ivec3 box, std::uint64_t bytes, std::string_view remedy) {
  if (bytes <= device.memoryBytes()) return;
  const bool limited = device.memoryBytes() < device.description().memoryBytes;
  fail(ErrorKind::OutOfMemory, "a volume of {}x{}x{} voxels needs {} MiB of device memory and {} {} MiB: {}crop or resample it{}",
       box.x, box.y, box.z, (bytes + 0xfffff) >> 20, limited ? fmt::format("{} is", Parameter("memory-limit")) : device.description().name + " has",
       device.memoryBytes() >> 20, limited ? "raise that, or " : "", remedy);
}

void checkBoxFits(const Device& device, const HierarchyLayout& hierarchy) {
  const glm::ivec3 box = hierarchy.levels.front().dimensions;
  const glm::dvec3 size(double(hierarchy.levels.front().rowPitch), box.y, box.z);
  if (size.x * size.y * size.z > double(kMaxNumberedVoxels))
    fail(ErrorKind::OutOfMemory, "a volume of {}x{}x{} voxels has more than the {} that can be numbered: crop or resample it", box.x,
         box.y, box.z, kMaxNumberedVoxels);
  checkBinds(device, box, occupancyBytes(hierarchy), sizeof(shader::OccupancyWord));
  checkHolds(device, box, occupancyBytes(hierarchy) + brickBytes(box));
}

void checkStoresFit(const Device& device, const DeviceVolume& volume) {
  const std::uint64_t bytes = extinctionBytes(volume.storedBlocks());
  const std::uint64_t most =
      std::min<std::uint64_t>(device.limits().maxTexelBufferElements * sizeof(glm::vec4), device.maximumAllocation());
  const glm::ivec3 box = volume.layout.dimensions;
  if (bytes > most)
    fail(ErrorKind::OutOfMemory,
         "a volume of {}x{}x{} voxels needs {} MiB in one piece for its extinction and {} has at most {} MiB: crop or resample it",
         box.x, box.y, box.z, bytes >> 20, device.description().name, most >> 20);
}

}  // namespace freevoxels
