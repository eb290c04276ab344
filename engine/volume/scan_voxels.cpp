#include "engine/volume/scan_voxels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kEdge = ScalarBricks::kEdge;

template <typename Value>
float sampleAt(const std::byte* place, const SampleBlock& block) {
  std::byte bytes[sizeof(Value)];
  std::memcpy(bytes, place, sizeof(Value));
  if (block.isSwapped) std::reverse(bytes, bytes + sizeof(Value));
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  if (block.slope == 1.0 && block.intercept == 0.0) return float(value);
  return float(double(value) * block.slope + block.intercept);
}

}  // namespace

ScanVoxels::ScanVoxels(glm::ivec3 dimensions)
    : dimensions_(dimensions),
      cells_((dimensions + (kEdge - 1)) / kEdge),
      bricks_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z)) {
  tbb::parallel_for(std::size_t(0), bricks_.size(), [&](std::size_t i) { bricks_[i].fill(kInactiveVoxel); });
}

void ScanVoxels::put(const SampleBlock& block) {
  const glm::ivec3 end = block.first + block.extent;
  for (int axis = 0; axis < 3; ++axis) {
    FV_CHECK_LE(0, block.first[axis]);
    FV_CHECK_LE(end[axis], dimensions_[axis]);
  }
  withSampleType(block.type, [&](auto typed) {
    using Value = decltype(typed);
    tbb::parallel_for(block.first.z, end.z, [&](int z) {
      for (int y = block.first.y; y < end.y; ++y) {
        const std::size_t row = std::size_t(y - block.first.y) + std::size_t(block.extent.y) * std::size_t(z - block.first.z);
        const std::byte* sample = block.samples + row * std::size_t(block.extent.x) * sizeof(Value);
        const std::size_t cellRow = std::size_t(cells_.x) * (std::size_t(y / kEdge) + std::size_t(cells_.y) * std::size_t(z / kEdge));
        for (int x = block.first.x; x < end.x; ++x, sample += sizeof(Value))
          bricks_[cellRow + std::size_t(x / kEdge)][ScalarBricks::indexInBrick({x % kEdge, y % kEdge, z % kEdge})] =
              sampleAt<Value>(sample, block);
      }
    });
  });
}

ScalarBricks ScanVoxels::take() {
  std::vector<glm::ivec3> cells;
  cells.reserve(bricks_.size());
  for (glm::ivec3 cell(0); cell.z < cells_.z; ++cell.z)
    for (cell.y = 0; cell.y < cells_.y; ++cell.y)
      for (cell.x = 0; cell.x < cells_.x; ++cell.x) cells.push_back(cell);
  return ScalarBricks::of(dimensions_, std::move(cells), std::move(bricks_));
}

}  // namespace freevoxels
