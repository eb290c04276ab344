#include "engine/visibility/detail_rule.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/footprint.h"

namespace freevoxels {

namespace {

/// Relative margin for the device's rounding of distances.
constexpr double kRangeMargin = 1e-3;

/// Relative change of an orthographic camera's scale during which a level comes in.
constexpr double kLevelRange = 0.25;

/// Largest length in pixels of a voxel's edge at distance 1, at the sides of the image, where perspective
/// stretches it; for an orthographic camera anywhere.
double pixelsPerEdge(const glm::dmat3& rows, const PixelRays& rays, glm::ivec2 imageSize) {
  double longest = 0.0;
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {0.0, rays.orthographic ? 0.0 : double(imageSize[axis])})
      longest = std::max(longest, glm::length(rows[axis] - side * rows[2]));
  return longest;
}

/// Smallest and largest nearestDistance of the blocks of a level.
glm::dvec2 distances(const DetailRule& rule, const HierarchyLayout& hierarchy, int level) {
  const glm::ivec3 last = hierarchy.levels[std::size_t(level)].dimensions - 1;
  glm::dvec2 range(rule.nearestDistance({level, {0, 0, 0}}));
  for (int corner = 1; corner < 8; ++corner) {
    const double distance =
        rule.nearestDistance({level, last * glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)});
    range = {std::min(range.x, distance), std::max(range.y, distance)};
  }
  return range;
}

}  // namespace

double DetailRule::nearestDistance(const Block& block) const {
  const glm::dvec3 centre = (glm::dvec3(block.cell) + 0.5) * double(block.edge()) - 0.5;
  const glm::dvec3 steepness = glm::abs(viewAxis);
  return glm::dot(viewAxis, centre - eye) - 0.5 * block.edge() * (steepness.x + steepness.y + steepness.z);
}

bool DetailRule::isSmall(const Block& block) const {
  return block.edge() <= edgePerDistance * nearestDistance(block);
}

DetailRule detailRule(const HierarchyLayout& hierarchy, const PixelRays& rays, glm::ivec2 imageSize,
                      double lod) {
  const glm::dmat3 rows = glm::transpose(rays.indexToPixel());
  const double pixels = pixelsPerEdge(rows, rays, imageSize);
  DetailRule rule{.viewAxis = rows[2], .eye = rays.origin};
  if (rays.orthographic) {
    while (rule.coarsest < hierarchy.top() && Block{.level = rule.coarsest + 1}.edge() * pixels <= lod)
      ++rule.coarsest;
    rule.finest = rule.coarsest;
    if (rule.coarsest > 0)
      rule.coarsestShare = std::min((lod / (Block{.level = rule.coarsest}.edge() * pixels) - 1.0) / kLevelRange, 1.0);
    return rule;
  }
  rule.edgePerDistance = std::min(lod / pixels, 0.5 / (kFootprintRadius * glm::length(rows[2])));
  for (int level = 1; level <= hierarchy.top(); ++level) {
    const glm::dvec2 range = rule.edgePerDistance * distances(rule, hierarchy, level);
    const int edge = Block{.level = level}.edge();
    if (edge <= range.x * (1.0 - kRangeMargin)) rule.finest = level;
    if (edge <= range.y * (1.0 + kRangeMargin)) rule.coarsest = level;
  }
  return rule;
}

}  // namespace freevoxels
