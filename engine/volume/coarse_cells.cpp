#include "engine/volume/coarse_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

namespace {

constexpr int kMaxSkipped = 8;  // groups of slices

/// The range of the values of some voxels; empty if low > high.
struct Range {
  float low = std::numeric_limits<float>::max(), high = kInactiveVoxel;

  void add(const Range& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

/// Adds the values of the voxels of a brick that have data and lie between the planes `low` and `end` - 1 across z to the ranges of a plane
/// of cells. The range of a cell includes `below` and `above` more voxels at its lower and upper sides.
void addBrick(std::vector<Range>& ranges, glm::ivec2 cells, const ScalarBricks& scalars, std::size_t number, glm::ivec2 planes, int edge,
              int below, int above) {
  const ScalarBricks::Brick brick = scalars.brick(number);
  const glm::ivec3 place = scalars.firstVoxel(number);
  const glm::ivec3 begin = glm::max(-place, 0), end = glm::min(scalars.dimensions() - place, ScalarBricks::kEdge);
  // The cells of which voxel v is a part.
  const auto firstOf = [&](int v) { return std::max(v - above, 0) / edge; };
  const auto lastOf = [&](int v, int count) { return std::min((v + below) / edge, count - 1); };
  const int firstX = firstOf(place.x + begin.x), lastX = lastOf(place.x + end.x - 1, cells.x);
  for (int z = std::max(begin.z, planes[0] - place.z); z < std::min(end.z, planes[1] - place.z); ++z)
    for (int y = begin.y; y < end.y; ++y) {
      const float* const row = &brick[ScalarBricks::indexInBrick({0, y, z})];
      const int firstY = firstOf(place.y + y), lastY = lastOf(place.y + y, cells.y);
      for (int x = firstX; x <= lastX; ++x) {
        Range range;
        const int last = std::min((x + 1) * edge + above - place.x, end.x);
        for (int v = std::max(x * edge - below - place.x, begin.x); v < last; ++v) {
          range.low = std::min(range.low, row[v] == kInactiveVoxel ? range.low : row[v]);
          range.high = std::max(range.high, row[v]);
        }
        for (int cellY = firstY; cellY <= lastY; ++cellY) ranges[std::size_t(x + cells.x * cellY)].add(range);
      }
    }
}

/// The ranges of the values in cells of `edge` voxels that have some. A range includes `below` and `above` (0 or 1) more voxels at the
/// cell's lower and upper sides.
CellRanges rangesOf(const Volume& volume, const ScalarBricks& scalars, int edge, int below, int above) {
  CellRanges result{.dimensions = (volume.dimensions + edge - 1) / edge, .cells = {}};
  const std::vector<std::size_t> order = scalars.inOrder();
  const auto planeOf = [&](std::size_t brick) { return scalars.firstVoxel(brick).z; };
  const std::size_t perPlane = std::size_t(result.dimensions.x) * std::size_t(result.dimensions.y);
  std::vector<std::vector<CellRanges::Cell>> found(std::size_t(result.dimensions.z));
  tbb::parallel_for(0, result.dimensions.z, [&](int plane) {
    const glm::ivec2 planes(plane * edge - below, (plane + 1) * edge + above);
    const auto first = std::ranges::lower_bound(order, planes[0] - ScalarBricks::kEdge + 1, {}, planeOf);
    const auto end = std::ranges::lower_bound(first, order.end(), planes[1], {}, planeOf);
    if (first == end) return;
    std::vector<Range> ranges(perPlane);
    for (auto brick = first; brick != end; ++brick)
      addBrick(ranges, glm::ivec2(result.dimensions), scalars, *brick, planes, edge, below, above);
    for (std::size_t i = 0; i < perPlane; ++i)
      if (ranges[i].low <= ranges[i].high)
        found[std::size_t(plane)].push_back({std::uint32_t(i + std::size_t(plane) * perPlane), ranges[i].low, ranges[i].high});
  });
  std::size_t count = 0;
  for (const auto& plane : found) count += plane.size();
  result.cells.reserve(count);
  for (const auto& plane : found) result.cells.insert(result.cells.end(), plane.begin(), plane.end());
  return result;
}

/// Marks the cells for whose range of values `holds(low, high)` is true.
template <typename Holds>
void markCells(Cells& cells, const CellRanges& ranges, const Holds& holds) {
  for (const CellRanges::Cell& cell : ranges.cells)
    if (holds(cell.low, cell.high)) cells.values[cell.index] = 1;
}

}  // namespace

CellRanges scalarRanges(const Volume& volume, int edge) {
  return rangesOf(volume, volume.scalars, edge, 0, 1);
}

Cells metCells(const CellRanges& ranges, const Volume& volume, const TransferFunction& function) {
  Cells cells(ranges.dimensions);
  const TransferIntegral integral(function, volume.minimum, volume.maximum);
  markCells(cells, ranges, [&](float low, float high) { return integral.isOccupied(low, high); });
  return cells;
}

Cells metCells(const Volume& volume, const Classification& classification, int edge, float density) {
  if (classification.isPost(volume)) return metCells(scalarRanges(volume, edge), volume, *classification.transferFunction);
  Cells cells((volume.dimensions + edge - 1) / edge);
  if (classification.transferFunction) {
    const TransferIntegral integral(*classification.transferFunction, volume.minimum, volume.maximum);
    markCells(cells, rangesOf(volume, volume.scalars, edge, 1, 1), [&](float low, float high) { return integral.isOccupied(low, high); });
  } else {
    markCells(cells, rangesOf(volume, volume.scalars, edge, 0, 0), [&](float, float high) { return high > density; });
  }
  if (classification.emission && volume.temperature) {
    const auto shines = [&](float, float high) { return brightestLight(*classification.emission, *volume.temperature, high) > 0.0; };
    markCells(cells, rangesOf(volume, volume.temperature->values, edge, 0, 0), shines);
  }
  return cells;
}

Cells coarserCells(const Cells& cells) {
  Cells result((cells.dimensions + 1) / 2);
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < cells.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < cells.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < cells.dimensions.x; ++cell.x) result.values[result.index(cell / 2)] |= cells.at(cell);
  return result;
}

Cells spread(const Cells& cells, int low, int high) {
  Cells result = cells;
  const glm::ivec3 n = cells.dimensions;
  for (int axis = 0; axis < 3; ++axis) {
    const Cells from = result;
    const glm::ivec3 step(axis == 0, axis == 1, axis == 2);
    const int stride = axis == 0 ? 1 : cells.strides()[axis - 1];
    for (int by = low; by <= high; ++by) {
      if (by == 0) continue;
      const glm::ivec3 begin = glm::max(-by * step, 0), end = glm::min(n - by * step, n);
      for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y) {
          std::uint8_t* const to = &result.values[result.index({0, y, z})];
          const std::uint8_t* const neighbours = from.values.data() + (to - result.values.data()) + by * stride;
          for (int x = begin.x; x < end.x; ++x) to[x] |= neighbours[x];
        }
    }
  }
  return result;
}

Cells groupsToSkip(const Cells& met) {
  Cells skips(met.dimensions), near = met;
  for (std::size_t i = 0; i < met.values.size(); ++i) skips.values[i] = met.values[i] ? 0 : 1;
  for (int groups = 1; groups <= kMaxSkipped; ++groups) {
    near = spread(near, -1, 1);
    for (std::size_t i = 0; i < met.values.size(); ++i) skips.values[i] = near.values[i] ? skips.values[i] : std::uint8_t(groups);
  }
  return skips;
}

}  // namespace freevoxels
