#pragma once
// Voxels and blocks of them as the camera sees them, in double precision: what the references for the
// additive and for the sorted picture share.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "engine/octree/hierarchy_layout.h"
#include "engine/scene/camera.h"
#include "engine/volume/volume.h"

namespace freevoxels {

struct ProjectedSplat {
  glm::dvec2 centre{0.0};               ///< pixels
  double distance = 0.0;                ///< of the centre along the viewing axis, world units
  glm::dvec3 toEye{0.0};                ///< from the block's own centre, index space, any length
  glm::dvec3 pixelX{0.0}, pixelY{0.0};  ///< a pixel's width and height there, index space
  glm::dmat2 shape{1.0};   ///< S'⁻¹ · |Dc|²: dᵀ shape d / |D|² is r²/R², or its widened like
  double widening = 1.0;   ///< sqrt(det S / det S')
  double edge2 = 1.0;      ///< square of the edge in pixels where it is shortest
  double amplitude = 1.0;  ///< the widening times the block's voxels, over those of a face of its cube
  bool cut = false;        ///< a perspective camera's eye plane cuts the kernel: centre and shape say nothing
  glm::dvec3 fromEye{0.0};  ///< where it is cut: from the eye to the voxel's centre, index space
  double ahead = 1.0;       ///< orthographic: the part of the kernel that is in front of the eye plane, about
};

/// What a splat does to a pixel.
struct CoveredPixel {
  std::size_t index;
  glm::dvec2 offset;  ///< of its centre from the splat's, pixels
  double omega;  ///< line integral of the kernel in front of the eye, world length; 0 outside the footprint
  double
      ahead;  ///< a cut kernel: world length from the eye to where the ray is nearest to the voxel's centre
};

class SplatProjector {
 public:
  SplatProjector(const Volume& volume, const Camera& camera, glm::ivec2 imageSize);

  /// With its kernel around `place` in index space. Empty where it is not drawn: the kernel is behind the eye
  /// plane. A perspective camera's may cut voxels' kernels, but none of a coarser block.
  std::optional<ProjectedSplat> project(const Block& block, glm::dvec3 place) const;
  std::optional<ProjectedSplat> project(const Block& block) const {
    return project(block, box(block).centre());
  }
  /// Of an index into Volume::values.
  Block voxel(std::uint32_t index) const;
  BlockBox box(const Block& block) const { return boxOf(block, dimensions_); }

  /// From a position in index space, which need not be a voxel's; index space, any length. At the eye itself
  /// against the ray of the top left corner.
  glm::dvec3 toEye(glm::dvec3 position) const;
  /// World length of a lattice layer in the viewing direction.
  double layerLength(const ProjectedSplat& splat) const;
  /// What of its own light leaves so many lattice layers in the viewing direction: (1 - exp(-x)) / x, x their
  /// optical depth.
  double leaving(const ProjectedSplat& splat, double extinction, int layers = 1) const;
  /// Opacity of so many lattice layers in the viewing direction per world length: (1 - exp(-sigma s)) / s.
  double opacity(const ProjectedSplat& splat, double extinction, int layers = 1) const;

  /// Calls `visit` with every pixel that the splat may cover.
  void forEachPixel(const ProjectedSplat& splat, const std::function<void(const CoveredPixel&)>& visit) const;
  /// World length from the eye to a voxel whose kernel is cut.
  double distanceFromEye(const ProjectedSplat& splat) const {
    return glm::length(indexToWorld_ * splat.fromEye);
  }

 private:
  glm::dvec3 rayDirection(glm::dvec2 pixel) const;
  CoveredPixel cover(const ProjectedSplat& splat, glm::ivec2 pixel) const;

  glm::ivec3 dimensions_;
  glm::ivec2 imageSize_;
  PixelRays rays_;
  glm::dmat3 toPixel_;  ///< from the eye, index space, to (x, y, 1) times the distance; orthographic (x, y,
                        ///< distance)
  glm::dmat3 indexToWorld_;
};

}  // namespace freevoxels
