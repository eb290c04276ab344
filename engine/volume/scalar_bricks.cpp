#include "engine/volume/scalar_bricks.h"

#include <algorithm>
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
  bricks_.reserve(bricks);
}

ScalarBricks::Brick& ScalarBricks::makeBrick(glm::ivec3 cell) {
  checkCell(cell);
  std::int32_t& number = numbers_[cell];
  if (number < 0) {
    FV_CHECK_LT(bricks_.size(), kMaxBricks);
    number = std::int32_t(bricks_.size());
    cells_.push_back(cell);
    bricks_.emplace_back().fill(kInactiveVoxel);
  }
  return bricks_[std::size_t(number)];
}

ScalarBricks ScalarBricks::cropped(glm::ivec3 low, glm::ivec3 high) const {
  const glm::ivec3 place = low + corner_;
  ScalarBricks result(high - low + 1, place % kEdge);
  result.reserve(bricks().size());
  for (std::size_t i = 0; i < bricks().size(); ++i) {
    const glm::ivec3 cell = cells_[i] - place / kEdge;
    if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, result.cells()))) continue;
    Brick& brick = result.makeBrick(cell);
    brick = bricks()[i];
    const glm::ivec3 first = cell * kEdge - result.corner_;  // of the brick, in the new box
    const glm::ivec3 begin = glm::max(-first, glm::ivec3(0)), end = glm::min(result.dimensions_ - first, glm::ivec3(kEdge));
    if (begin == glm::ivec3(0) && end == glm::ivec3(kEdge)) continue;
    for (glm::ivec3 v(0); v.z < kEdge; ++v.z)
      for (v.y = 0; v.y < kEdge; ++v.y)
        for (v.x = 0; v.x < kEdge; ++v.x)
          if (glm::any(glm::lessThan(v, begin)) || glm::any(glm::greaterThanEqual(v, end))) brick[indexInBrick(v)] = kInactiveVoxel;
  }
  return result;
}

void ScalarBricks::copyRow(int y, int z, std::span<float> row) const {
  const glm::ivec3 place(0, y + corner_.y, z + corner_.z);
  for (int cell = 0; cell < cells().x; ++cell) {
    const int begin = std::max(cell * kEdge - corner_.x, 0), end = std::min((cell + 1) * kEdge - corner_.x, dimensions_.x);
    const Brick* const brick = brickAt({cell, place.y / kEdge, place.z / kEdge});
    if (brick == nullptr) {
      std::fill(row.begin() + begin, row.begin() + end, kInactiveVoxel);
      continue;
    }
    const glm::ivec3 first((begin + corner_.x) % kEdge, place.y % kEdge, place.z % kEdge);
    std::copy_n(&(*brick)[indexInBrick(first)], end - begin, row.begin() + begin);
  }
}

}  // namespace freevoxels
