#pragma once
// Which blocks of the octree a frame leaves out before any splat is made: Subr et al. 2007, Section 3.3.
// Hidden blocks are found with the table, a plenoptic opacity function (Gao, Huang, Johnson, Moorhead 2003).

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

struct CullRule {
  /// Index positions p with planes.xyz . (p - middle) + planes.w < 0 are to the left or right of the image,
  /// above or below it, or behind the eye; `middle` is that of the volume. In pixels at distance 1;
  /// orthographic: in pixels.
  std::array<glm::dvec4, 5> planes{};
  bool outside = false;      ///< whether a part of the volume is outside of the image and can be left out
  double hiddenDepth = 0.0;  ///< optical depth to the eye from which on a block is hidden; 0 if none is

  bool leavesNothingOut() const { return !outside && hiddenDepth == 0.0; }
};

/// The rule of a frame of splats. Blocks are only hidden from the additive composite, to which they add no more than the table says: the
/// normalised one has their optical depth, too, and where all voxels on a ray are dark the least dark one decides the colour. The eye must
/// be outside of the volume's box: for an eye inside, the table's optical depths count to the outside and exceed those to the eye.
CullRule cullRule(glm::ivec3 dimensions, const PixelRays& rays, const FrameSettings& settings);

/// Whether any block can be hidden, that is, dark in all four table directions around a line of sight
/// (shaders/table_occlusion.glsl), if no voxel has more than `largestDepths` in front of it, by direction.
bool canHide(const TableSettings& table, std::span<const double> largestDepths,
             const glm::dmat3& indexToWorld, double hiddenDepth);

}  // namespace freevoxels
