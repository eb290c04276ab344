#include "engine/hierarchy/volume_memory.h"

#include <limits>
#include <numeric>
#include <vector>

#include "engine/core/error.h"
#include "engine/volume/device_bricks.h"
#include "shaders/frame_interface.h"

namespace freevoxels {

namespace {

/// Shaders number voxels by signed integers, those of the padding too.
constexpr std::uint64_t kMostNumbered = std::numeric_limits<std::int32_t>::max();

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
         "it, or draw it without the attenuation table (--draw gather, no ambient light)",
         box.x, box.y, box.z, bytes >> 20, device.description().name, most >> 20);
}

/// The least that the sweeps need.
void checkSweepBinds(const Device& device, const HierarchyLayout& hierarchy, DirectionSet directions) {
  const GridLayout& voxels = hierarchy.levels.front();
  const SweepPlan least = planSweep(voxels, directions, sweepStyle(device), 0);
  checkBinds(device, voxels.dimensions, least.slabBytes, sizeof(glm::vec4));
  checkBinds(device, voxels.dimensions, least.keptBytes, sizeof(glm::vec4));
}

/// Of the sweeps the least that they need: they make do with what there is.
void checkHolds(const Device& device, const HierarchyLayout& hierarchy, VolumeMemory memory,
                DirectionSet directions, const char* mend) {
  memory.sweep = planSweep(hierarchy.levels.front(), directions, sweepStyle(device), 0).bytes();
  if (memory.peak() <= device.memoryBytes()) return;
  const glm::ivec3 box = hierarchy.levels.front().dimensions;
  const bool limited = device.memoryBytes() < device.description().memoryBytes;
  fail(ExitCode::OutOfMemory,
       "a volume of {}x{}x{} voxels needs {} MiB of device memory and {} {} MiB: {}crop or resample it{}",
       box.x, box.y, box.z, (memory.peak() + 0xfffff) >> 20,
       limited ? "--memory-limit is" : device.description().name + " has", device.memoryBytes() >> 20,
       limited ? "raise that, or " : "", mend);
}

/// Of a box that holds nothing.
VolumeMemory emptyMemory(const Device& device, const HierarchyLayout& hierarchy) {
  return volumeMemory(hierarchy, std::vector<std::uint64_t>(hierarchy.levels.size(), 0),
                      DirectionSet::Directions26, {}, sweepStyle(device));
}

/// Of a batch, were all bricks there.
std::uint64_t brickBytes(glm::ivec3 box) {
  const glm::u64vec3 cells((box + 2 * (ScalarBricks::kEdge - 1)) / ScalarBricks::kEdge);
  return std::min<std::uint64_t>(cells.x * cells.y * cells.z * sizeof(ScalarBricks::Brick), kBatchBytes);
}

/// Of all levels: the shaders see them as one buffer of words, and as one of texels.
std::uint64_t occupancyBytes(const HierarchyLayout& hierarchy) {
  return hierarchy.paddedBlocks() / shader::kBlocksPerWord * sizeof(shader::OccupancyWord);
}

}  // namespace

StoredKinds storedKinds(const DeviceVolume& volume) {
  return {.colors = volume.hasColors, .emission = volume.hasEmission()};
}

VolumeMemory volumeMemory(const HierarchyLayout& hierarchy, std::span<const std::uint64_t> stored,
                          DirectionSet directions, StoredKinds kinds, const SweepStyle& style) {
  const std::uint64_t blocks = std::accumulate(stored.begin(), stored.end(), std::uint64_t(0));
  const std::uint64_t voxels = stored.front(), coarse = blocks - voxels;
  std::uint64_t codes = blocks;
  for (std::size_t level = 1; level < stored.size(); ++level) codes += boundBytes(stored[level]);
  return {.occupancy = occupancyBytes(hierarchy),
          .extinction = extinctionBytes(blocks),
          .table = codes * std::uint64_t(directionCount(directions)),
          .colors = kinds.colors ? voxels * sizeof(float) + coarse * sizeof(glm::uvec2) : 0,
          .emission = kinds.emission ? blocks * sizeof(std::uint32_t) : 0,
          // Of all blocks and of those of a frame, with a bit for each that could be one and two bytes for
          // each that has children.
          .lists = (blocks + voxels) * sizeof(std::uint32_t) + blocks + 2 * coarse,
          .bricks = brickBytes(hierarchy.levels.front().dimensions) *
                    (1u + (kinds.colors ? 1u : 0u) + (kinds.emission ? 1u : 0u)),
          .sweep = planSweep(hierarchy.levels.front(), directions, style,
                             std::numeric_limits<std::uint64_t>::max())
                       .bytes(),
          .splats = std::min<std::uint64_t>(voxels, shader::kSplatsPerChunk) * sizeof(shader::Splat)};
}

SweepStyle sweepStyle(const Device& device) {
  SweepStyle style = sweepStyleOf(device.isCpu());
  style.mostSlabBytes = largestBinding(device, sizeof(glm::vec4));
  return style;
}

std::uint64_t maximumVoxels(const Device& device) {
  const HierarchyLayout cube(glm::ivec3(1024));
  const auto voxels = double(cube.levels.front().voxels());
  const auto bytes = double(occupancyBytes(cube));
  const double most =
      double(std::min(largestBinding(device, sizeof(shader::OccupancyWord)), device.memoryBytes()));
  return std::uint64_t(std::min(most * (voxels / bytes), double(kMostNumbered)));
}

void checkBoxFits(const Device& device, const HierarchyLayout& hierarchy) {
  const glm::ivec3 box = hierarchy.levels.front().dimensions;
  checkBinds(device, box, occupancyBytes(hierarchy), sizeof(shader::OccupancyWord));
  if (hierarchy.levels.front().paddedVoxels() > kMostNumbered)
    fail(ExitCode::OutOfMemory,
         "a volume of {}x{}x{} voxels has more than the {} that can be numbered: crop or resample it", box.x,
         box.y, box.z, kMostNumbered);
  checkHolds(device, hierarchy, emptyMemory(device, hierarchy), DirectionSet::Directions26, "");
}

void checkStoresFit(const Device& device, const DeviceVolume& volume) {
  const std::uint64_t bytes = extinctionBytes(volume.storedBlocks());
  const std::uint64_t most = std::min<std::uint64_t>(device.limits().maxTexelBufferElements * sizeof(glm::vec4), device.maximumAllocation());
  const glm::ivec3 box = volume.layout.dimensions;
  if (bytes > most)
    fail(ExitCode::OutOfMemory,
         "a volume of {}x{}x{} voxels needs {} MiB in one piece for its extinction and {} has at most {} MiB: crop or resample it",
         box.x, box.y, box.z, bytes >> 20, device.description().name, most >> 20);
}

void checkSplatsFit(const Device& device, const DeviceVolume& volume) {
  checkBinds(device, volume.layout.dimensions, volume.activeVoxels * sizeof(std::uint32_t), sizeof(std::uint32_t));
}

void checkTableFits(const Device& device, const DeviceVolume& volume, DirectionSet directions) {
  checkBinds(device, volume.layout.dimensions, volume.planeBytes(), 1);
  checkSweepBinds(device, volume.hierarchy, directions);
  checkHolds(
      device, volume.hierarchy,
      volumeMemory(volume.hierarchy, volume.stored, directions, storedKinds(volume), sweepStyle(device)),
      directions, directions == DirectionSet::Directions26 ? "" : ", or take 26 directions");
}

}  // namespace freevoxels
