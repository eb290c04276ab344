#include "engine/volume/scan_voxels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <type_traits>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kEdge = ScalarBricks::kEdge;

template <typename Value>
Value sampleAt(const std::byte* place, bool isSwapped) {
  std::byte bytes[sizeof(Value)];
  std::memcpy(bytes, place, sizeof(Value));
  if (isSwapped) std::reverse(bytes, bytes + sizeof(Value));
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  return value;
}

template <typename Value>
float rescaled(Value value, double slope, double intercept) {
  if (slope == 1.0 && intercept == 0.0) return float(value);
  return float(double(value) * slope + intercept);
}

template <typename Bricks>
constexpr bool kAreFloats = std::is_same_v<Bricks, ScalarBricks::Bricks>;

}  // namespace

std::size_t ScanVoxels::bytesOfVoxel(SampleType type) {
  const std::size_t bytes = bytesOf(type);
  return bytes <= sizeof(std::uint16_t) ? bytes : sizeof(float);
}

ScanVoxels::ScanVoxels(SampleType type, glm::ivec3 dimensions, glm::ivec3 first)
    : type_(type), dimensions_(dimensions), first_(first), cells_((dimensions + (kEdge - 1)) / kEdge) {
  const std::size_t count = std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z);
  if (bytesOf(type) == sizeof(std::uint8_t))
    bricks_.emplace<ScalarBricks::BricksOf<std::uint8_t>>(count);
  else if (bytesOf(type) == sizeof(std::uint16_t))
    bricks_.emplace<ScalarBricks::BricksOf<std::uint16_t>>(count);
  else
    bricks_.emplace<ScalarBricks::Bricks>(count);
  std::visit(
      [&]<typename Bricks>(Bricks& bricks) {
        const auto absent = kAreFloats<Bricks> ? kInactiveVoxel : 0.0f;
        tbb::parallel_for(std::size_t(0), bricks.size(),
                          [&](std::size_t i) { bricks[i].fill(typename Bricks::value_type::value_type(absent)); });
      },
      bricks_);
}

bool ScanVoxels::takes(const SampleBlock& block) const {
  if (std::holds_alternative<ScalarBricks::Bricks>(bricks_)) return true;
  return block.type == type_ && scale_ == Scale{block.slope, block.intercept};
}

void ScanVoxels::put(const SampleBlock& block, int component) {
  FV_CHECK_LT(component, block.components);
  std::shared_lock lock(mutex_);
  if (!takes(block)) {
    lock.unlock();
    const std::unique_lock changing(mutex_);
    if (!scale_) scale_ = {block.slope, block.intercept};
    if (!takes(block)) useFloats();
  }
  if (!lock.owns_lock()) lock.lock();
  withSampleType(block.type, [&](auto typed) {
    using Value = decltype(typed);
    const auto fillBricks = [&]<typename Bricks>(Bricks& bricks) {
      using Stored = typename Bricks::value_type::value_type;
      if constexpr (kAreFloats<Bricks>)
        fill<Value>(block, component, bricks, [&](Value value) { return rescaled(value, block.slope, block.intercept); });
      else if constexpr (sizeof(Value) == sizeof(Stored))
        fill<Value>(block, component, bricks, [](Value value) { return Stored(value); });
    };
    std::visit(fillBricks, bricks_);
  });
}

template <typename Value, typename Stored, typename Convert>
void ScanVoxels::fill(const SampleBlock& block, int component, ScalarBricks::BricksOf<Stored>& bricks, const Convert& convert) const {
  const glm::ivec3 begin = glm::max(block.first, first_), end = glm::min(block.first + block.extent, first_ + dimensions_);
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
        bricks[cellRow + std::size_t(x / kEdge)][ScalarBricks::indexInBrick({x % kEdge, there.y % kEdge, there.z % kEdge})] =
            convert(sampleAt<Value>(sample, block.isSwapped));
    }
  });
}

std::vector<float> ScanVoxels::valuesOfCodes() const {
  const Scale scale = scale_.value_or(Scale{1.0, 0.0});
  std::vector<float> values(std::size_t(1) << 8 * bytesOf(type_));
  withSampleType(type_, [&](auto typed) {
    using Value = decltype(typed);
    for (std::size_t code = 0; code < values.size(); ++code) values[code] = rescaled(Value(code), scale.slope, scale.intercept);
  });
  return values;
}

void ScanVoxels::useFloats() {
  const ScalarBricks codes = take();
  ScalarBricks::Bricks floats(codes.count());
  tbb::parallel_for(std::size_t(0), floats.size(), [&](std::size_t i) { floats[i] = codes.brick(i); });
  bricks_ = std::move(floats);
}

ScalarBricks ScanVoxels::take() {
  std::vector<glm::ivec3> cells;
  cells.reserve(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z));
  for (glm::ivec3 cell(0); cell.z < cells_.z; ++cell.z)
    for (cell.y = 0; cell.y < cells_.y; ++cell.y)
      for (cell.x = 0; cell.x < cells_.x; ++cell.x) cells.push_back(cell);
  return std::visit(
      [&]<typename Bricks>(Bricks& bricks) {
        if constexpr (kAreFloats<Bricks>)
          return ScalarBricks::of(dimensions_, std::move(cells), std::move(bricks));
        else
          return ScalarBricks::ofCodes(dimensions_, std::move(cells), std::move(bricks), valuesOfCodes());
      },
      bricks_);
}

}  // namespace freevoxels
