#include "engine/attenuation/swept_bricks.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

/// Calls `visit` with the bricks that are marked in a box, by their places in it.
template <typename Visit>
void forEachBrickIn(const SparseGrid<std::uint8_t>& bricks, const VoxelRange& box, const Visit& visit) {
  const glm::ivec3 first = box.first / ScalarBricks::kEdge, counts = (box.extent() + ScalarBricks::kEdge - 1) / ScalarBricks::kEdge;
  const std::size_t stored = bricks.nodes().size() * std::tuple_size_v<SparseGrid<std::uint8_t>::Node>;
  if (double(counts.x) * double(counts.y) * double(counts.z) > double(stored)) {
    bricks.forEach([&](glm::ivec3 brick, std::uint8_t) {
      if (glm::all(glm::greaterThanEqual(brick, first)) && glm::all(glm::lessThan(brick, first + counts))) visit(brick - first);
    });
    return;
  }
  glm::ivec3 place;
  for (place.z = 0; place.z < counts.z; ++place.z)
    for (place.y = 0; place.y < counts.y; ++place.y)
      for (place.x = 0; place.x < counts.x; ++place.x)
        if (bricks.at(first + place) != 0) visit(place);
}

}  // namespace

SparseGrid<std::uint8_t> withNeighbours(SparseGrid<std::uint8_t> bricks) {
  for (int axis = 0; axis < 3; ++axis) {
    const SparseGrid<std::uint8_t> from = bricks;
    from.forEach([&](glm::ivec3 brick, std::uint8_t) {
      for (const int by : {-1, 1}) {
        glm::ivec3 beside = brick;
        beside[axis] += by;
        if (beside[axis] >= 0 && beside[axis] < from.dimensions()[axis]) bricks[beside] = 1;
      }
    });
  }
  return bricks;
}

Cells cellsOfBricks(const SparseGrid<std::uint8_t>& bricks, const VoxelRange& box) {
  constexpr int kCells = ScalarBricks::kEdge / shader::kSkipGroup;  // along a brick's edge
  Cells cells((box.extent() + shader::kSkipGroup - 1) / shader::kSkipGroup);
  forEachBrickIn(bricks, box, [&](glm::ivec3 place) {
    const glm::ivec3 first = place * kCells, end = glm::min(first + kCells, cells.dimensions);
    for (glm::ivec3 cell = first; cell.z < end.z; ++cell.z)
      for (cell.y = first.y; cell.y < end.y; ++cell.y)
        for (cell.x = first.x; cell.x < end.x; ++cell.x) cells.values[cells.index(cell)] = 1;
  });
  return cells;
}

SweptBricks::SweptBricks(const SparseGrid<std::uint8_t>& bricks, const VoxelRange& box, const FaceRays& fan)
    : fan_(fan), layers_(std::size_t((box.extent()[fan.axis] + ScalarBricks::kEdge - 1) / ScalarBricks::kEdge)) {
  forEachBrickIn(bricks, box, [&](glm::ivec3 place) {
    layers_[std::size_t(place[fan.axis])].push_back(glm::ivec2(place[(fan.axis + 1) % 3], place[(fan.axis + 2) % 3]));
  });
  for (std::vector<glm::ivec2>& layer : layers_)
    std::ranges::sort(layer, {}, [](glm::ivec2 place) { return std::tuple(place.y, place.x); });
}

std::size_t SweptBricks::mostInALayer() const {
  std::size_t most = 0;
  for (const std::vector<glm::ivec2>& layer : layers_) most = std::max(most, layer.size());
  return most;
}

/// The layer of a plane, or the nearest one where that is beside the box.
int SweptBricks::layerOf(int plane) const {
  const int coordinate = fan_.firstPlane + fan_.direction * plane;
  return std::clamp(coordinate, 0, int(layers_.size()) * ScalarBricks::kEdge - 1) / ScalarBricks::kEdge;
}

std::vector<SweptBricks::Stretch> SweptBricks::stretchesOf(int begin, int end) const {
  std::vector<Stretch> stretches;
  for (int plane = begin; plane < end; ++plane) {
    if (plane == begin || layerOf(plane) != layerOf(plane - 1)) stretches.push_back({plane, plane, ofLayer(layerOf(plane))});
    stretches.back().end = plane + 1;
  }
  return stretches;
}

/// Where a position on a plane lies between the rays, counted in rays.
glm::dvec2 SweptBricks::rayAt(glm::dvec2 side, int plane) const {
  const double up = double(fan_.firstPlane + fan_.direction * plane) - fan_.farthest;
  return (side - fan_.origin - fan_.slope * up) / (fan_.spacing * (1.0 + fan_.convergence * up));
}

std::vector<std::uint32_t> SweptBricks::groupsOf(int begin, int end) const {
  constexpr double kReach = 4.0;  // rays around a position that are interpolated, with some to spare
  constexpr std::int64_t kGroup = shader::kRaySweepThreads;
  const std::int64_t raysOfRow = fan_.rayCount.x;
  std::vector<std::uint8_t> isRead((fan_.rays() + kGroup - 1) / kGroup, 0);
  const auto [firstLayer, lastLayer] = std::minmax({layerOf(begin - 1), layerOf(end)});
  for (int layer = firstLayer; layer <= lastLayer; ++layer)
    for (const glm::ivec2 brick : ofLayer(layer)) {
      glm::dvec2 low(std::numeric_limits<double>::max()), high = -low;
      for (const int plane : {std::max(begin - 1, 0), end})
        for (int corner = 0; corner < 4; ++corner) {
          const glm::ivec2 voxel = brick * ScalarBricks::kEdge + glm::ivec2(corner % 2, corner / 2) * (ScalarBricks::kEdge - 1);
          const glm::dvec2 ray = rayAt(voxel, plane);
          low = glm::min(low, ray);
          high = glm::max(high, ray);
        }
      // Positions beside the rays read the outermost four.
      const glm::dvec2 last(fan_.rayCount - 1);
      const glm::ivec2 from(glm::clamp(low - kReach, glm::dvec2(0.0), last - 3.0)), to(glm::clamp(high + kReach, glm::dvec2(3.0), last));
      for (std::int64_t row = from.y; row <= to.y; ++row)
        for (std::int64_t group = (row * raysOfRow + from.x) / kGroup; group <= (row * raysOfRow + to.x) / kGroup; ++group)
          isRead[std::size_t(group)] = 1;
    }
  std::vector<std::uint32_t> groups;
  for (std::size_t group = 0; group < isRead.size(); ++group)
    if (isRead[group] != 0) groups.push_back(std::uint32_t(group));
  return groups;
}

}  // namespace freevoxels
