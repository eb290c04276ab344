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

ScanVoxels::ScanVoxels(glm::ivec3 dimensions, glm::ivec3 first)
    : dimensions_(dimensions),
      first_(first),
      cells_((dimensions + (kEdge - 1)) / kEdge),
      bricks_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z)) {
  tbb::parallel_for(std::size_t(0), bricks_.size(), [&](std::size_t i) { bricks_[i].fill(kInactiveVoxel); });
}

void ScanVoxels::put(const SampleBlock& block, int component) {
  FV_CHECK_LT(component, block.components);
  const glm::ivec3 begin = glm::max(block.first, first_), end = glm::min(block.first + block.extent, first_ + dimensions_);
  withSampleType(block.type, [&](auto typed) {
    using Value = decltype(typed);
    const std::size_t step = sizeof(Value) * std::size_t(block.components);
    tbb::parallel_for(begin.z, std::max(begin.z, end.z), [&](int z) {
      for (int y = begin.y; y < end.y; ++y) {
        const std::size_t row = std::size_t(y - block.first.y) + std::size_t(block.extent.y) * std::size_t(z - block.first.z);
        const std::size_t skipped = row * std::size_t(block.extent.x) + std::size_t(begin.x - block.first.x);
        const std::byte* sample = block.samples + skipped * step + std::size_t(component) * sizeof(Value);
        const glm::ivec3 there = glm::ivec3(0, y, z) - first_;
        const std::size_t cellRow =
            std::size_t(cells_.x) * (std::size_t(there.y / kEdge) + std::size_t(cells_.y) * std::size_t(there.z / kEdge));
        for (int x = begin.x - first_.x; x < end.x - first_.x; ++x, sample += step)
          bricks_[cellRow + std::size_t(x / kEdge)][ScalarBricks::indexInBrick({x % kEdge, there.y % kEdge, there.z % kEdge})] =
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
