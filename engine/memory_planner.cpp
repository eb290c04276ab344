#include "engine/memory_planner.h"

#include <limits>
#include <numeric>

#include "engine/attenuation/attenuation_table.h"
#include "engine/attenuation/ray_sweep.h"
#include "engine/lighting/light_pass.h"
#include "engine/octree/volume_limits.h"
#include "engine/splatting/frame_targets.h"
#include "engine/volume/occupied_count.h"
#include "engine/volume/voxel_classifier.h"
#include "shaders/frame_interface.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

/// What a frame could do without may take one part in this many of the device's memory: exact rays towards lights, for which the table
/// is a substitute; and quads that only a later frame reads again. The larger part remains for what a frame needs.
constexpr std::uint64_t kOptionalDivisor = 4;

/// The images of a frame, and the buffers through which they are read back.
std::uint64_t frameBytes(const FrameSettings& settings) {
  return 2 * targetBytes(settings);
}

/// Bytes of device memory that frames of splats with the table take at least, images included. Counts the occupied voxels on the host, and
/// may be up to a quarter too large.
std::uint64_t leastMemory(const Device& device, const Volume& volume, const Classification& classification, DirectionSet directions,
                          const FrameSettings& settings) {
  std::vector<bool> occupied(volume.voxelCount());
  const VoxelClassifier classifier(classification, volume);
  constexpr int n = ScalarBricks::kEdge;
  for (std::size_t brick = 0; brick < volume.scalars.count(); ++brick) {
    const glm::ivec3 first = volume.scalars.firstVoxel(brick);
    const glm::ivec3 begin = glm::max(first, 0), end = glm::min(first + n, volume.dimensions);
    for (glm::ivec3 v = begin; v.z < end.z; ++v.z)
      for (v.y = begin.y; v.y < end.y; ++v.y)
        for (v.x = begin.x; v.x < end.x; ++v.x) {
          const ClassifiedVoxel voxel = classifier.at(v);
          occupied[volume.at(v.x, v.y, v.z)] = voxel.extinction > 0.0 || voxel.emission != glm::dvec3(0.0);
        }
  }
  const HierarchyLayout hierarchy(volume.dimensions);
  const std::vector<std::uint64_t> stored = countOccupiedBlocks(volume.dimensions, std::move(occupied));
  const StoredKinds kinds{.colors = classification.transferFunction || volume.albedo, .emission = classification.emission.has_value()};
  const std::uint64_t bytes = volumeMemory(hierarchy, stored, directions, kinds, sweepStyle(device)).peak() + frameBytes(settings);
  // A margin for what volumeMemory does not count: an eighth for lists that are rounded up, 2 MiB for constants and counters.
  return bytes + bytes / 8 + (std::uint64_t(2) << 20);
}

}  // namespace

StoredKinds storedKinds(const DeviceVolume& volume) {
  return {.colors = volume.hasColors, .emission = volume.hasEmission()};
}

VolumeMemory volumeMemory(const HierarchyLayout& hierarchy, std::span<const std::uint64_t> stored, DirectionSet directions,
                          StoredKinds kinds, const SweepStyle& style) {
  const std::uint64_t blocks = std::accumulate(stored.begin(), stored.end(), std::uint64_t(0));
  const std::uint64_t voxels = stored.front(), coarse = blocks - voxels;
  const std::uint64_t channels = 1u + (kinds.colors ? 1u : 0u) + (kinds.emission ? 1u : 0u);
  std::uint64_t codes = blocks;
  for (std::size_t level = 1; level < stored.size(); ++level) codes += boundBytes(stored[level]);
  const GridLayout& box = hierarchy.levels.front();
  return {.occupancy = occupancyBytes(hierarchy),
          .extinction = extinctionBytes(blocks),
          .table = codes * std::uint64_t(directionCount(directions)),
          .colors = kinds.colors ? voxels * sizeof(float) + coarse * sizeof(glm::uvec2) : 0,
          .emission = kinds.emission ? blocks * sizeof(std::uint32_t) : 0,
          // Indices of all blocks and of those that a frame draws, a bit for each block that could be drawn and two bytes for each
          // block that has children.
          .lists = (blocks + voxels) * sizeof(std::uint32_t) + blocks + 2 * coarse,
          .bricks = brickBytes(box.dimensions) * channels,
          .sweep = planSweep(box, directions, style, std::numeric_limits<std::uint64_t>::max()).bytes(),
          .splats = std::min<std::uint64_t>(voxels, shader::kSplatsPerChunk) * sizeof(shader::Splat)};
}

LightAttenuation planLightAttenuation(const Device& device, const DeviceVolume& volume, const VolumeMemory& memory,
                                      const FrameSettings& settings) {
  const LightAttenuation wanted = lightAttenuationFor(settings);
  if (settings.lighting->attenuation != LightAttenuation::Auto || wanted == LightAttenuation::Table) return wanted;
  const RayMemory rays = lightRayMemory(volume, *settings.lighting);
  const std::uint64_t others = memory.peak() + frameBytes(settings);
  const bool fits = rays.bytes <= device.memoryBytes() / kOptionalDivisor && rays.bytes + others <= device.memoryBytes() &&
                    rays.largest <= device.maximumAllocation();
  return fits ? LightAttenuation::Exact : LightAttenuation::Table;
}

std::uint64_t planKeptQuadBytes(const Device& device) {
  return device.memoryBytes() / kOptionalDivisor;
}

std::uint64_t leastGatherBytes(std::uint64_t brickVoxels, glm::ivec3 dimensions, const glm::dmat4& indexToWorld, const Lighting* lighting,
                               bool emits) {
  std::uint64_t quadBytes = sizeof(glm::uvec2), rays = 0;  // quads of extinctions
  if (emits) quadBytes += sizeof(glm::uvec4);              // of emission
  if (lighting != nullptr) {
    const bool perVoxel = lighting->lights.size() > std::size_t(shader::kMaxSampleLights);
    if (perVoxel) quadBytes += 2 * sizeof(glm::uvec4);  // of source terms and their directions
    for (const Light& light : lighting->lights) {
      if (!perVoxel) quadBytes += sizeof(std::uint16_t) + sizeof(glm::uvec2);  // the code of the light, and quads of codes
      rays += rayBytes(dimensions, lightSource(light, indexToWorld));
    }
  }
  return brickVoxels * quadBytes + rays;
}

Error withWholeNeed(const Error& error, const Device& device, const Volume& volume, const Classification& classification,
                    DirectionSet directions, const FrameSettings& settings) {
  const std::uint64_t limit = device.memoryBytes();
  if (error.kind() != ErrorKind::OutOfMemory || limit >= device.description().memoryBytes) return error;
  const std::uint64_t bytes = leastMemory(device, volume, classification, directions, settings);
  if (bytes <= limit) return error;
  const glm::ivec3 box = volume.dimensions;
  return Error(ErrorKind::OutOfMemory,
               fmt::format("a volume of {}x{}x{} voxels and an image of {}x{} pixels need {} MiB of device memory and {} is {} MiB: raise "
                           "that, or crop or resample the volume",
                           box.x, box.y, box.z, settings.size.x, settings.size.y, (bytes + 0xfffff) >> 20, Parameter("memory-limit"),
                           limit >> 20));
}

std::uint64_t maximumVoxels(const Device& device) {
  const HierarchyLayout cube(glm::ivec3(1024));  // bytes per voxel hardly depend on the size
  const auto voxels = double(cube.levels.front().voxels());
  const auto bytes = double(occupancyBytes(cube));
  const double most = double(std::min(device.largestBinding(sizeof(shader::OccupancyWord)), device.memoryBytes()));
  return std::uint64_t(std::min(most * (voxels / bytes), double(kMaxNumberedVoxels)));
}

bool exceedsDevice(std::uint64_t deviceBytes, std::uint64_t mostVoxels, glm::ivec3 box, std::uint64_t activeVoxels) {
  // The least that a voxel with data takes: its extinction, and its indices in the list of occupied voxels and in that of drawn ones.
  constexpr std::uint64_t kMinBytes = sizeof(float) + 2 * sizeof(std::uint32_t);
  const glm::u64vec3 size(box);
  return size.x * size.y * size.z > mostVoxels || activeVoxels > deviceBytes / kMinBytes;
}

void checkSplatsFit(const Device& device, const DeviceVolume& volume) {
  checkBinds(device, volume.layout.dimensions, volume.stored.front() * sizeof(std::uint32_t), sizeof(std::uint32_t));
}

void checkTableFits(const Device& device, const DeviceVolume& volume, DirectionSet directions) {
  const glm::ivec3 box = volume.layout.dimensions;
  const SweepPlan least = planSweep(volume.layout, directions, sweepStyle(device), 0);
  checkBinds(device, box, volume.planeBytes(), 1);
  checkBinds(device, box, least.slabBytes, sizeof(glm::vec4));
  checkBinds(device, box, least.keptBytes, sizeof(glm::vec4));
  VolumeMemory memory = volumeMemory(volume.hierarchy, volume.stored, directions, storedKinds(volume), sweepStyle(device));
  memory.sweep = least.bytes();  // sweeps make do with as little as that
  checkHolds(device, box, memory.peak(), directions == DirectionSet::Directions26 ? "" : ", or take 26 directions");
}

}  // namespace freevoxels
