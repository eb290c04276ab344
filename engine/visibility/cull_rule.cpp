#include "engine/visibility/cull_rule.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/footprint.h"

namespace freevoxels {

namespace {

/// Margin in pixels for widened footprints, which reach farther, and for rounding.
constexpr double kFootprintMargin = kFootprintRadius + 0.5;

std::array<glm::dvec4, 5> imagePlanes(glm::dvec3 middle, const PixelRays& rays, glm::ivec2 size) {
  // Rows of the affine map from a position to (x t, y t, t), orthographic (x, y, t), and to 1.
  const glm::dmat3 rows = glm::transpose(rays.indexToPixel());
  const auto row = [&](int i) { return glm::dvec4(rows[i], glm::dot(rows[i], middle - rays.origin)); };
  const glm::dvec4 one = rays.orthographic ? glm::dvec4(0.0, 0.0, 0.0, 1.0) : row(2);
  std::array<glm::dvec4, 5> planes{row(0) + kFootprintMargin * one, (size.x + kFootprintMargin) * one - row(0),
                                   row(1) + kFootprintMargin * one, (size.y + kFootprintMargin) * one - row(1), row(2)};
  for (glm::dvec4& plane : planes) plane /= glm::length(glm::dvec3(plane));
  return planes;
}

/// Whether the kernels of all voxels are on the inner side of all planes.
bool areAllInside(const std::array<glm::dvec4, 5>& planes, glm::ivec3 dimensions) {
  const glm::dvec3 half = 0.5 * glm::dvec3(dimensions - 1) + kFootprintRadius;
  return std::ranges::all_of(planes, [&](const glm::dvec4& plane) {
    return plane.w >= glm::dot(glm::abs(glm::dvec3(plane)), half);
  });
}

bool isOutsideBox(const PixelRays& rays, glm::ivec3 dimensions) {
  if (rays.orthographic) return true;
  return glm::any(glm::lessThan(rays.origin, glm::dvec3(-0.5))) ||
         glm::any(glm::greaterThan(rays.origin, glm::dvec3(dimensions) - 0.5));
}

}  // namespace

CullRule cullRule(glm::ivec3 dimensions, const PixelRays& rays, const FrameSettings& settings) {
  CullRule rule;
  if (settings.gathers() || settings.isSorted() || !settings.splats().culling) return rule;
  rule.planes = imagePlanes(0.5 * glm::dvec3(dimensions - 1), rays, settings.size);
  rule.outside = !areAllInside(rule.planes, dimensions);
  const double threshold = double(settings.splats().cullThreshold);
  if (threshold > 0.0 && settings.splats().composite == Composite::Additive && isOutsideBox(rays, dimensions))
    rule.hiddenDepth = -std::log(threshold);
  return rule;
}

bool canHide(const TableSettings& table, std::span<const double> largestDepths,
             const glm::dmat3& indexToWorld, double hiddenDepth) {
  const int cells = int(table.directions);
  const auto lengthOf = [&](glm::ivec3 cell) {
    return table.pathLengthCorrection ? glm::length(indexToWorld * glm::dvec3(cell)) : 1.0;
  };
  for (int face = 0; face < 6; ++face)
    for (int b = -cells; b < cells; ++b)
      for (int a = -cells; a < cells; ++a) {
        std::array<glm::ivec3, 4> corners;
        for (int i = 0; i < 4; ++i) {
          corners[std::size_t(i)][face / 2] = face % 2 == 0 ? cells : -cells;
          corners[std::size_t(i)][(face / 2 + 1) % 3] = a + i % 2;
          corners[std::size_t(i)][(face / 2 + 2) % 3] = b + i / 2;
        }
        // A line of sight between these corners crosses no layer for longer than the longest of them.
        double longest = 0.0;
        for (const glm::ivec3 corner : corners) longest = std::max(longest, lengthOf(corner));
        if (std::ranges::all_of(corners, [&](glm::ivec3 corner) {
              const auto direction = std::size_t(directionIndex(table.directions, corner));
              return largestDepths[direction] * longest >= hiddenDepth * lengthOf(corner);
            }))
          return true;
      }
  return false;
}

}  // namespace freevoxels
