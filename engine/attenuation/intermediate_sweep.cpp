#include "engine/attenuation/intermediate_sweep.h"

#include <cstdint>
#include <vector>

#include "embedded/attenuation_sweep_half.h"
#include "engine/attenuation/attenuation_table.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

constexpr DirectionSet kSet = DirectionSet::Directions98;

/// The cells of the 72 directions that are not among the 26. Their lattice step is the cell itself.
std::vector<glm::ivec3> halfCells() {
  std::vector<glm::ivec3> cells;
  for (int i = 0; i < directionCount(kSet); ++i)
    if (directionCell(kSet, i) % 2 != glm::ivec3(0)) cells.push_back(directionCell(kSet, i));
  return cells;
}

/// Offsets, along one axis, from a voxel to the voxels nearest to the middle of a step.
std::vector<int> halfwayOffsets(int step) {
  if (step % 2 == 0) return {step / 2};
  return {0, step};
}

std::vector<glm::ivec2> halfwayOffsets(glm::ivec2 step) {
  std::vector<glm::ivec2> offsets;
  for (const int x : halfwayOffsets(step.x))
    for (const int y : halfwayOffsets(step.y)) offsets.emplace_back(x, y);
  return offsets;
}

/// The direction's steps along the march axis and along the side axis (neither x nor the march axis). The
/// march goes against the direction.
glm::ivec2 marchAndSide(glm::ivec3 cell) {
  return cell.z != 0 ? glm::ivec2(cell.z, cell.y) : glm::ivec2(cell.y, 0);
}

std::pair<int, int> pipelineKey(glm::ivec3 cell) {
  return {-cell.x, int(halfwayOffsets(marchAndSide(cell)).size())};
}

std::uint64_t threadsOf(const shader::HalfSweepPush& push, int voxelsPerThread) {
  return std::uint64_t(push.sideCount) * std::uint64_t(std::abs(push.marchStep)) *
         std::uint64_t(push.rowPitch / voxelsPerThread);
}

/// Push constants of a direction's sweep, without the slab.
shader::HalfSweepPush halfSweepPush(const SlabSweep& sweep, glm::ivec3 cell) {
  const DeviceVolume& volume = sweep.volume;
  const bool pathLengthCorrection = sweep.table.settings.pathLengthCorrection;
  const glm::ivec3 extent = volume.layout.dimensions;
  const int row = volume.layout.rowPitch, plane = row * extent.y;
  const bool alongZ = cell.z != 0;
  const glm::ivec2 step = marchAndSide(cell);
  shader::HalfSweepPush push{
      .rowPitch = row,
      .start = alongZ ? 0 : sweep.firstVoxel(),
      .marchCount = alongZ ? extent.z : extent.y,
      .marchStride = alongZ ? plane : row,
      .marchStep = -step.x,
      .sideCount = alongZ ? extent.y : sweep.slab.count(),
      .sideStride = alongZ ? row : plane,
      .sideStep = -step.y,
      .stepLength = float(stepLength(volume.indexToWorld, 0.5 * glm::dvec3(cell), pathLengthCorrection))};
  int rows = 0;
  for (const glm::ivec2 offset : halfwayOffsets(step)) push.halfway[rows++] = offset;
  return push;
}

}  // namespace

IntermediateSweep::IntermediateSweep(const Device& device, AttenuationCode code, int voxelsPerThread)
    : voxelsPerThread_(voxelsPerThread) {
  for (const glm::ivec3 cell : halfCells()) {
    const auto key = pipelineKey(cell);
    if (pipelines_.contains(key)) continue;
    pipelines_[key] = makeComputePipeline(device, shaders::attenuation_sweep_half, {std::uint32_t(code), std::uint32_t(voxelsPerThread), std::uint32_t(key.first),
         std::uint32_t(key.second)});
  }
}

void IntermediateSweep::record(SlabSweep& sweep) const {
  for (const glm::ivec3 cell : halfCells()) {
    // The march goes against the direction.
    if (sweep.slab.upwards ? cell.z > 0 : cell.z <= 0) continue;
    shader::HalfSweepPush push = halfSweepPush(sweep, cell);
    const std::uint64_t threads = threadsOf(push, voxelsPerThread_);
    push.slab = cell.z != 0
                    ? sweep.marchAlongZ(threads * std::uint64_t(linesPerThread(voxelsPerThread_, cell.x)))
                    : sweep.marchWithinPlanes(push.marchCount);
    sweep.commands.dispatchLinear(pipelines_.at(pipelineKey(cell)),
                                  sweep.bindings(sweep.table.planes[std::size_t(directionIndex(kSet, cell))]),
                                  push, threads);
  }
}

}  // namespace freevoxels
