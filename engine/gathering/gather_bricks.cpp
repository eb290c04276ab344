#include "engine/gathering/gather_bricks.h"

#include <span>
#include <tuple>

namespace freevoxels {

namespace {

/// A place far from all volumes.
constexpr int kOutside = 1 << 29;

}  // namespace

GatherBricks::GatherBricks(const Device& device, const HierarchyLayout& hierarchy, bool scalars)
    : device_(device), hierarchy_(hierarchy), scalars_(scalars), places_{glm::ivec4(kOutside)} {}

/// A position in a cell stays for one more edge in that cell and its next neighbours along the positive axes, so these decide. The light of
/// a surface is looked up 2.5 blocks outside of it, so bricks extend one cell farther, on all sides.
void GatherBricks::include(const Cells& occupied) {
  const int top = hierarchy_.top(), finest = std::min(shader::kSkipLevels, top);
  Cells cells = occupied;                               // one cell if the volume is smaller than a cell
  std::vector<Cells> met, around{spread(cells, 0, 1)};  // by level, starting above the finest
  for (int level = finest; level <= top; ++level) {
    met.push_back(spread(cells, 0, 1));
    around.push_back(coarserCells(spread(cells, -1, 1)));
    // Blocks above interpolated scalars are means of voxels that are classified with half the way to their neighbours.
    cells = coarserCells(level == finest && scalars_ ? spread(cells, -1, 0) : cells);
  }

  levels_.clear();
  cells_.clear();
  std::vector<std::uint8_t> skips;
  std::size_t next = 0;
  for (int number = 0; number <= top; ++number) {
    const int brickLevel = std::min(number + shader::kBrickLevels, top), skipLevel = std::min(number + shader::kSkipLevels, top);
    const Cells& bricks = around[std::size_t(brickLevel - finest)];
    const Cells skipCells = groupsToSkip(met[std::size_t(skipLevel - finest)]);
    cells_.push_back(bricks.dimensions);
    levels_.push_back({.dimensions = hierarchy_.levels[std::size_t(number)].dimensions,
                       .firstCell = int(next),
                       .cellStrides = bricks.strides(),
                       .firstSkip = int(skips.size()),
                       .skipStrides = skipCells.strides(),
                       .lastSkip = skipCells.dimensions - 1});
    const std::uint32_t first = count();
    numbers_.resize(std::max(numbers_.size(), next + bricks.values.size()), 0);
    glm::ivec3 cell;
    for (cell.z = 0; cell.z < bricks.dimensions.z; ++cell.z)
      for (cell.y = 0; cell.y < bricks.dimensions.y; ++cell.y)
        for (cell.x = 0; cell.x < bricks.dimensions.x; ++cell.x, ++next) {
          if (bricks.at(cell) == 0 || numbers_[next] != 0) continue;
          numbers_[next] = count();
          places_.emplace_back(cell * shader::kGatherBrickEdge, 0);
        }
    if (count() > first) ranges_.push_back({.level = number, .first = first, .end = count()});
    skips.insert(skips.end(), skipCells.values.begin(), skipCells.values.end());
  }
  std::tie(numberBuffer_, numberTexels_) = uploadTexels(device_, std::as_bytes(std::span(numbers_)), VK_FORMAT_R32_UINT, "brick numbers");
  std::tie(placeBuffer_, placeTexels_) =
      uploadTexels(device_, std::as_bytes(std::span(places_)), VK_FORMAT_R32G32B32A32_UINT, "brick cells");
  std::tie(skipBuffer_, skipTexels_) = uploadTexels(device_, std::as_bytes(std::span(skips)), VK_FORMAT_R8_UINT, "cells to skip");
}

}  // namespace freevoxels
