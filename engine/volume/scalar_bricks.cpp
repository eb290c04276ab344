#include "engine/volume/scalar_bricks.h"

#include <algorithm>

namespace freevoxels {

ScalarBricks::ScalarBricks(glm::ivec3 dimensions, glm::ivec3 corner)
    : dimensions_(dimensions),
      corner_(corner),
      cellCount_((dimensions + corner + kEdge - 1) / kEdge),
      numbers_(std::size_t(cellCount_.x) * std::size_t(cellCount_.y) * std::size_t(cellCount_.z), -1) {}

void ScalarBricks::reserve(std::size_t bricks) {
  cells_.reserve(bricks);
  bricks_.reserve(bricks);
}

ScalarBricks::Brick& ScalarBricks::makeBrick(glm::ivec3 cell) {
  std::int32_t& number = numbers_[cellIndex(cell)];
  if (number < 0) {
    number = std::int32_t(bricks_.size());
    cells_.push_back(cell);
    bricks_.emplace_back().fill(kInactiveVoxel);
  }
  return bricks_[std::size_t(number)];
}

ScalarBricks ScalarBricks::cropped(glm::ivec3 low, glm::ivec3 high) const {
  const glm::ivec3 place = low + corner_;
  ScalarBricks result(high - low + 1, place % kEdge);
  result.reserve(bricks_.size());
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    const glm::ivec3 cell = cells_[i] - place / kEdge;
    if (glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) &&
        glm::all(glm::lessThan(cell, result.cellCount_)))
      result.makeBrick(cell) = bricks_[i];
  }
  return result;
}

void ScalarBricks::copyRow(int y, int z, std::span<float> row) const {
  const glm::ivec3 place(0, y + corner_.y, z + corner_.z);
  for (int cell = 0; cell < cellCount_.x; ++cell) {
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
