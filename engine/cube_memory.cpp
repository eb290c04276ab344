// What a frame takes that is drawn cube by cube.

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/cube_drawing_state.h"

namespace freevoxels {

/// The most bricks with data that a cube is read with.
std::uint64_t CubeDrawing::State::mostBricks() {
  constexpr int kBrick = ScalarBricks::kEdge;
  const CubeLevel& base = levelAt(0);
  const SparseGrid<std::uint8_t> bricks = source->bricks();
  std::uint64_t most = 0;
  for (const VoxelRange& cube : base.cubes.pieces()) {
    const VoxelRange box = withHalo(cube, base.outline().dimensions);
    const glm::ivec3 first = box.first / kBrick, end = (box.end + kBrick - 1) / kBrick;
    std::uint64_t count = 0;
    for (glm::ivec3 brick = first; brick.z < end.z; ++brick.z)
      for (brick.y = first.y; brick.y < end.y; ++brick.y)
        for (brick.x = first.x; brick.x < end.x; ++brick.x) count += bricks.at(brick);
    most = std::max(most, count);
  }
  return most;
}

/// Bytes of device memory that a frame takes, rounded up: its images and sums, and a cube or the sweep of a light.
std::uint64_t CubeDrawing::State::leastBytes(const Camera& camera, const FrameSettings& wanted) {
  const Volume& outline = levelAt(0).outline();
  const LightGroups groups = groupLights(wanted);
  const FrameSettings& settings = groups.settings.front();
  const shader::GatherFrame lattice = latticeOf(camera, settings);
  std::uint64_t axes = 0;
  for (int axis = 0; axis < 3; ++axis) axes += someRayHasAxis(lattice, axis) ? 1 : 0;
  const std::uint64_t voxels = (mostBricks() + 1) * std::tuple_size_v<ScalarBricks::Brick>;
  const std::uint64_t slots = settings.lighting ? settings.lighting->lights.size() : 0;
  // Of a voxel: what is built of it, and its quads, of which those of light and emission are for all axes along which rays march.
  const std::uint64_t built = 24, quads = sizeof(glm::uvec2) * (1 + slots) + (classification.emission ? 2 * sizeof(glm::uvec4) : 0);
  std::uint64_t largest = voxels * (built + slots * sizeof(std::uint16_t) + axes * quads);
  for (const Light& light : groups.all)
    largest = std::max(largest, SweptLight::leastBytes(levelAt(0).source, lightSource(light, outline.indexToWorld)));
  if (wanted.lighting && hasScatteredLight(*wanted.lighting, classification.emission.has_value()))
    largest = std::max(largest, scatteringBytes(device, outline, *wanted.lighting));
  constexpr std::uint64_t kSums = 2, kSumBytes = sizeof(glm::vec4) + sizeof(float);  // before and after the stencil
  const std::uint64_t sums =
      kSums * kSumBytes * std::uint64_t(lattice.samples.x) * std::uint64_t(lattice.samples.y) + GatherImage::rowBytes(lattice);
  const std::uint64_t bytes = 2 * targetBytes(wanted) + sums + largest;
  return bytes + bytes / 8 + (std::uint64_t(4) << 20);
}

/// `error`, of too little memory, or where the device's is limited a sentence with what the frame needs.
Error CubeDrawing::State::withNeed(const Error& error, const Camera& camera, const FrameSettings& wanted) {
  if (device.memoryBytes() >= device.description().memoryBytes) return error;
  const std::uint64_t bytes = leastBytes(camera, wanted);
  if (bytes <= device.memoryBytes()) return error;
  const glm::ivec3 box = source->outline().dimensions;
  return Error(
      ErrorKind::OutOfMemory,
      fmt::format("a volume of {}x{}x{} voxels and an image of {}x{} pixels need at least {} MiB of device memory, piece by piece, and "
                  "{} is {} MiB: raise that, or draw a smaller image",
                  box.x, box.y, box.z, wanted.size.x, wanted.size.y, (bytes + 0xfffff) >> 20, Parameter("memory-limit"),
                  device.memoryBytes() >> 20));
}

Error CubeDrawing::withNeed(const Error& error, const Camera& camera, const FrameSettings& settings) const {
  return state_->withNeed(error, camera, settings);
}

VolumeMemory CubeDrawing::memory() const {
  const DeviceVolume& whole = state_->levelAt(0).onDevice;
  const HierarchyLayout hierarchy(glm::min(whole.layout.dimensions, PieceTree::kCubeEdge + 2 * kHalo));
  std::vector<std::uint64_t> blocks(hierarchy.levels.size(), 0);
  blocks.front() = hierarchy.levels.front().voxels();
  VolumeMemory memory = volumeMemory(hierarchy, blocks, state_->table.directions, storedKinds(whole), sweepStyle(state_->device));
  memory.table = memory.sweep = memory.splats = 0;
  return memory;
}

}  // namespace freevoxels
