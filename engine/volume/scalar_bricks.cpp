#include "engine/volume/scalar_bricks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr std::size_t kMaxBricks = std::numeric_limits<std::int32_t>::max();

}  // namespace

ScalarBricks::ScalarBricks(glm::ivec3 dimensions, glm::ivec3 corner)
    : dimensions_(dimensions),
      corner_(corner),
      numbers_((glm::i64vec3(dimensions) + glm::i64vec3(corner) + std::int64_t(kEdge - 1)) / std::int64_t(kEdge), -1) {}

ScalarBricks ScalarBricks::of(glm::ivec3 dimensions, std::vector<glm::ivec3> cells, Bricks bricks) {
  FV_CHECK_EQ(cells.size(), bricks.size());
  ScalarBricks result(dimensions);
  result.number(std::move(cells));
  result.bricks_ = std::move(bricks);
  return result;
}

template <typename Code>
ScalarBricks ScalarBricks::ofCodes(glm::ivec3 dimensions, std::vector<glm::ivec3> cells, BricksOf<Code> bricks, std::vector<float> values) {
  FV_CHECK_EQ(cells.size(), bricks.size());
  FV_CHECK_EQ(values.size(), std::size_t(1) << 8 * sizeof(Code));
  ScalarBricks result(dimensions);
  result.number(std::move(cells));
  result.bricks_ = std::move(bricks);
  result.values_ = std::move(values);
  return result;
}
template ScalarBricks ScalarBricks::ofCodes(glm::ivec3, std::vector<glm::ivec3>, BricksOf<std::uint8_t>, std::vector<float>);
template ScalarBricks ScalarBricks::ofCodes(glm::ivec3, std::vector<glm::ivec3>, BricksOf<std::uint16_t>, std::vector<float>);

void ScalarBricks::checkCell(glm::ivec3 cell) const {
  for (int axis = 0; axis < 3; ++axis) {
    FV_CHECK_LE(0, cell[axis]);
    FV_CHECK_LT(cell[axis], cells()[axis]);
  }
}

void ScalarBricks::number(std::vector<glm::ivec3> cells) {
  FV_CHECK_LE(cells.size(), kMaxBricks);
  cells_ = std::move(cells);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    checkCell(cells_[i]);
    std::int32_t& number = numbers_[cells_[i]];
    FV_CHECK_EQ(number, -1);
    number = std::int32_t(i);
  }
}

std::vector<std::size_t> ScalarBricks::inOrder() const {
  std::vector<std::size_t> order(cells_.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::sort(order, {}, [&](std::size_t brick) { return std::tuple(cells_[brick].z, cells_[brick].y, cells_[brick].x); });
  return order;
}

void ScalarBricks::reserve(std::size_t bricks) {
  cells_.reserve(bricks);
  if (Bricks* const floats = std::get_if<Bricks>(&bricks_)) floats->reserve(bricks);
}

ScalarBricks::Brick& ScalarBricks::makeBrick(glm::ivec3 cell) {
  checkCell(cell);
  editable();
  Bricks& bricks = std::get<Bricks>(bricks_);
  std::int32_t& number = numbers_[cell];
  if (number < 0) {
    FV_CHECK_LT(bricks.size(), kMaxBricks);
    number = std::int32_t(bricks.size());
    cells_.push_back(cell);
    bricks.emplace_back().fill(kInactiveVoxel);
  }
  return bricks[std::size_t(number)];
}

ScalarBricks::Brick ScalarBricks::brick(std::size_t number) const {
  Brick scalars;
  mapBrick(
      number, std::span<float>(scalars), [](float scalar) { return scalar; }, std::span<const float>(values_));
  return scalars;
}

std::span<ScalarBricks::Brick> ScalarBricks::editable() {
  if (!std::holds_alternative<Bricks>(bricks_)) {
    Bricks floats(count());
    tbb::parallel_for(std::size_t(0), count(), [&](std::size_t i) { floats[i] = brick(i); });
    bricks_ = std::move(floats);
    values_.clear();
  }
  return std::get<Bricks>(bricks_);
}

float ScalarBricks::decoded(std::size_t number, std::size_t indexInBrick) const {
  if (const auto* const bytes = std::get_if<BricksOf<std::uint8_t>>(&bricks_)) return values_[(*bytes)[number][indexInBrick]];
  return values_[std::get<BricksOf<std::uint16_t>>(bricks_)[number][indexInBrick]];
}

std::vector<std::uint64_t> ScalarBricks::codeCounts() const {
  using Counts = std::vector<std::uint64_t>;
  constexpr std::size_t kGrain = 4096;  // bricks, as many voxels as there are codes and more
  return std::visit(
      [&](const auto& bricks) {
        const auto count = [&](const tbb::blocked_range<std::size_t>& range, Counts counts) {
          if constexpr (!std::is_same_v<decltype(bricks), const Bricks&>)
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
              for (const auto code : bricks[i]) ++counts[code];
              forEachBeyond(i, [&](std::size_t voxel) { --counts[bricks[i][voxel]]; });
            }
          return counts;
        };
        const auto sum = [](Counts a, const Counts& b) {
          std::ranges::transform(a, b, a.begin(), std::plus());
          return a;
        };
        return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, bricks.size(), kGrain), Counts(values_.size()), count, sum);
      },
      bricks_);
}

std::uint64_t ScalarBricks::bytes() const {
  const std::size_t bytesOfVoxel = std::visit([](const auto& bricks) { return sizeof(bricks.front().front()); }, bricks_);
  return bytesOf(count(), bytesOfVoxel) + numbers_.bytes() + values_.size() * sizeof(float);
}

ScalarBricks ScalarBricks::cropped(glm::ivec3 low, glm::ivec3 high) const {
  const glm::ivec3 place = low + corner_;
  ScalarBricks result(high - low + 1, place % kEdge);
  std::vector<std::size_t> kept;
  std::vector<glm::ivec3> cells;
  for (std::size_t i = 0; i < count(); ++i) {
    const glm::ivec3 cell = cells_[i] - place / kEdge;
    if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, result.cells()))) continue;
    kept.push_back(i);
    cells.push_back(cell);
  }
  result.number(std::move(cells));
  result.values_ = values_;
  std::visit(
      [&]<typename All>(const All& all) {
        All& bricks = result.bricks_.emplace<All>();
        bricks.reserve(kept.size());
        for (const std::size_t i : kept) bricks.push_back(all[i]);
        if constexpr (std::is_same_v<All, Bricks>)
          for (std::size_t i = 0; i < bricks.size(); ++i)
            result.forEachBeyond(i, [&](std::size_t voxel) { bricks[i][voxel] = kInactiveVoxel; });
      },
      bricks_);
  return result;
}

}  // namespace freevoxels
