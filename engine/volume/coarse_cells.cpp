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

/// The range of the voxels x to `end` - 1 of a row, or to the end of the row.
Range rangeOf(const std::vector<float>& row, int x, int end) {
  Range range;
  for (const int last = std::min(end, int(row.size())); x < last; ++x) {
    const float value = row[std::size_t(x)];
    range.low = std::min(range.low, value == kInactiveVoxel ? range.low : value);
    range.high = std::max(range.high, value);
  }
  return range;
}

/// Marks the cells for whose range of values `holds(low, high)` is true. The range includes `below` and `above` (0 or 1) more voxels at the
/// cells' lower and upper sides.
template <typename Holds>
void markCells(Cells& cells, const ScalarBricks& scalars, int edge, int below, int above, const Holds& holds) {
  const glm::ivec3 n = scalars.dimensions();
  tbb::parallel_for(0, cells.dimensions.z, [&](int plane) {
    std::vector<Range> ranges(std::size_t(cells.dimensions.x) * std::size_t(cells.dimensions.y));
    std::vector<float> row(std::size_t(n.x));
    for (int z = std::max(plane * edge - below, 0); z < std::min((plane + 1) * edge + above, n.z); ++z)
      for (int y = 0; y < n.y; ++y) {
        scalars.copyRow(y, z, row);
        const int cellY = y / edge;
        for (int x = 0; x < cells.dimensions.x; ++x) {
          const Range range = rangeOf(row, std::max(x * edge - below, 0), (x + 1) * edge + above);
          Range* const there = &ranges[std::size_t(x + cells.dimensions.x * cellY)];
          there->add(range);
          if (above > 0 && y % edge == 0 && cellY > 0) (there - cells.dimensions.x)->add(range);
          if (below > 0 && (y + 1) % edge == 0 && cellY + 1 < cells.dimensions.y) (there + cells.dimensions.x)->add(range);
        }
      }
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (ranges[i].low <= ranges[i].high && holds(ranges[i].low, ranges[i].high))
        cells.values[i + std::size_t(plane) * ranges.size()] = 1;
  });
}

}  // namespace

Cells metCells(const Volume& volume, const Classification& classification, int edge, float density) {
  Cells cells((volume.dimensions + edge - 1) / edge);
  if (classification.transferFunction) {
    const TransferIntegral integral(*classification.transferFunction, volume.minimum, volume.maximum);
    const int below = classification.isPost(volume) ? 0 : 1;
    markCells(cells, volume.scalars, edge, below, 1, [&](float low, float high) { return integral.isOccupied(low, high); });
  } else {
    markCells(cells, volume.scalars, edge, 0, 0, [&](float, float high) { return high > density; });
  }
  if (classification.emission && volume.temperature) {
    const auto shines = [&](float, float high) { return brightestLight(*classification.emission, *volume.temperature, high) > 0.0; };
    markCells(cells, volume.temperature->values, edge, 0, 0, shines);
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
