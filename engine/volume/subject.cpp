#include "engine/volume/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace freevoxels {

namespace {

constexpr int kCellsAlongLongestSide = 64;
constexpr float kLeastSeen = 1.0f / 256.0f;  // as a fraction of the largest density, or of the largest opacity of a transfer function
constexpr double kMargin = 0.13;
// Along an axis of few voxels none is left out of the image, nor what interpolation draws beyond their faces.
constexpr int kFewVoxels = 16;
constexpr double kReachOfVoxels = 1.0;  // voxels

/// Makes what is below kLeastSeen of the largest opacity transparent.
void leaveFaintOut(std::vector<TransferFunction::OpacityPoint>& points) {
  using Point = TransferFunction::OpacityPoint;
  const float least = kLeastSeen * std::ranges::max(points, {}, &Point::opacity).opacity;
  std::vector<Point> kept;
  for (const Point& point : points) {
    if (!kept.empty()) {
      const Point& before = kept.back();
      const float above = std::max(before.opacity, point.opacity), below = std::min(before.opacity, point.opacity);
      if (below < least && least < above)  // where the function crosses the least
        kept.push_back({std::lerp(before.scalar, point.scalar, (least - before.opacity) / (point.opacity - before.opacity)), least});
    }
    kept.push_back(point);
  }
  for (Point& point : kept) point.opacity = std::max(point.opacity - least, 0.0f);
  points = std::move(kept);
}

}  // namespace

Subject boxOf(const Volume& volume) {
  const auto toWorld = [&](glm::dvec3 index) { return glm::dvec3(volume.indexToWorld * glm::dvec4(index, 1.0)); };
  const glm::dvec3 extent(volume.dimensions);
  Subject subject{.centre = toWorld((extent - 1.0) / 2.0)};
  for (int corner = 0; corner < 8; ++corner)
    subject.points.push_back(toWorld(glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) * extent - 0.5));
  return subject;
}

ContentCells contentCells(const Volume& volume, const Classification& classification) {
  const glm::ivec3 n = volume.dimensions;
  const int edge = (std::max({n.x, n.y, n.z}) + kCellsAlongLongestSide - 1) / kCellsAlongLongestSide;
  Classification visible = classification;
  if (visible.transferFunction) leaveFaintOut(visible.transferFunction->opacity);
  return {.cells = metCells(volume, visible, edge, kLeastSeen * volume.maximum), .edge = double(edge)};
}

bool isAsBaked(const Volume& volume, const Classification& classification) {
  // Another density scale leaves the content as it is; a transfer function does not.
  return volume.classification &&
         (volume.classificationIsFixed || (!classification.transferFunction && !volume.classification->transferFunction));
}

ContentCells contentCellsOf(glm::ivec3 dimensions, const Volume& sample, const Classification& classification) {
  const auto longest = [](glm::ivec3 n) { return double(std::max({n.x, n.y, n.z})); };
  ContentCells content = contentCells(sample, classification);
  content.edge *= longest(dimensions) / longest(sample.dimensions);  // shorter edges may have a single voxel of the sample
  return content;
}

namespace {

/// The part of a volume in whose cells something is seen, where its box has more voxels than can be numbered and the part is so small in it
/// that the cells do not show where it is; nothing otherwise.
std::optional<Volume> smallContent(const ContentCells& content, const Volume& volume) {
  constexpr int kSmall = 16;
  if (volume.voxelCount() <= std::size_t(std::numeric_limits<std::int32_t>::max())) return {};
  glm::ivec3 low = content.cells.dimensions, high(-1), cell;
  for (cell.z = 0; cell.z < content.cells.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < content.cells.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < content.cells.dimensions.x; ++cell.x)
        if (content.cells.at(cell) != 0) {
          low = glm::min(low, cell);
          high = glm::max(high, cell);
        }
  const glm::ivec3 n = volume.dimensions, first = low * int(content.edge), last = glm::min((high + 1) * int(content.edge), n) - 1;
  const glm::ivec3 extent = last - first + 1;
  if (high.x < 0 || std::max({extent.x, extent.y, extent.z}) > std::max({n.x, n.y, n.z}) / kSmall) return {};
  Volume part = outlineOf(volume);
  part.dimensions = extent;
  part.indexToWorld = glm::translate(volume.indexToWorld, glm::dvec3(first));
  part.scalars = volume.scalars.cropped(first, last);
  if (volume.temperature) part.temperature->values = volume.temperature->values.cropped(first, last);
  return part;
}

}  // namespace

Subject contentOf(const Volume& volume, const Classification& classification) {
  if (volume.content && isAsBaked(volume, classification)) return *volume.content;
  const ContentCells content = contentCells(volume, classification);
  if (const std::optional<Volume> part = smallContent(content, volume)) return contentOf(*part, classification);
  return subjectOf(content, volume);
}

Subject subjectOf(const ContentCells& content, const Volume& volume) {
  const glm::ivec3 n = volume.dimensions;
  const Cells& cells = content.cells;
  Subject subject = boxOf(volume);
  subject.margin = kMargin;

  std::vector<glm::dvec3> points;
  glm::dvec3 low(n), high(-1.0);
  for (int z = 0; z < cells.dimensions.z; ++z)
    for (int y = 0; y < cells.dimensions.y; ++y) {
      const auto* const row = &cells.values[cells.index({0, y, z})];
      const auto* const end = row + cells.dimensions.x;
      const auto* const first = std::find(row, end, 1);
      if (first == end) continue;
      const auto* last = end - 1;
      while (*last == 0) --last;
      glm::dvec3 from = glm::dvec3(first - row, y, z) * content.edge - 0.5;
      glm::dvec3 to = glm::min(glm::dvec3(last - row + 1, y + 1, z + 1) * content.edge, glm::dvec3(n)) - 0.5;
      for (int axis = 0; axis < 3; ++axis)
        if (n[axis] < kFewVoxels) {
          from[axis] = -0.5 - kReachOfVoxels;
          to[axis] = n[axis] - 0.5 + kReachOfVoxels;
        }
      low = glm::min(low, from);
      high = glm::max(high, to);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index = glm::mix(from, to, glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2));
        points.emplace_back(volume.indexToWorld * glm::dvec4(index, 1.0));
      }
    }
  if (points.empty()) return subject;
  subject.points = std::move(points);
  subject.centre = glm::dvec3(volume.indexToWorld * glm::dvec4((low + high) / 2.0, 1.0));
  return subject;
}

}  // namespace freevoxels
