#pragma once
// What of the octree a frame leaves out before any splat is made: Subr et al. 2007, Section 3.3; what hides
// behind others by the table itself, a plenoptic opacity function (Gao, Huang, Johnson, Moorhead 2003).

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

struct CullRule {
  /// Index positions p with planes.xyz . (p - middle) + planes.w < 0 are left or right of the image, above or
  /// below, or behind the eye; `middle` is the volume's. In pixels at distance 1; orthographic: in pixels.
  std::array<glm::dvec4, 5> planes{};
  bool outside = false;      ///< some of the volume is no part of the image and can be left out
  double hiddenDepth = 0.0;  ///< optical depth to the eye that hides a block; 0: none does

  bool leavesNothingOut() const { return !outside && hiddenDepth == 0.0; }
};

/// Blocks hide others where the table is read, from an eye outside of the volume's box: seen from inside, the
/// table's transmittances, which count from the outside, are less than those to the eye.
CullRule cullRule(glm::ivec3 dimensions, const PixelRays& rays, const FrameSettings& settings);

/// Whether anything can be dark in all four directions of the table around a line of sight, as the cut asks
/// (shaders/table_occlusion.glsl), where no voxel has more than these optical depths before it, by direction.
bool canHide(const TableSettings& table, std::span<const double> largestDepths,
             const glm::dmat3& indexToWorld, double hiddenDepth);

}  // namespace freevoxels
