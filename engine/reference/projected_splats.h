#pragma once
// Voxels and blocks projected to the image, in double precision: shared by the references of the additive and
// the sorted image.

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
  double distance = 0.0;                ///< distance of the centre along the viewing axis, in world units
  glm::dvec3 toEye{0.0};                ///< direction from the block's own centre, in index space, of any length
  glm::dvec3 pixelX{0.0}, pixelY{0.0};  ///< a pixel's width and height at the centre, in index space
  glm::dmat2 shape{1.0};   ///< S'⁻¹ · |Dc|²: dᵀ shape d / |D|² is r²/R², or that of the widened footprint
  double widening = 1.0;   ///< sqrt(det S / det S')
  double edge2 = 1.0;      ///< square of the edge in pixels where it is shortest
  double amplitude = 1.0;  ///< the widening times the block's number of voxels, divided by that of a face of its cube
  bool cut = false;        ///< whether a perspective camera's eye plane cuts the kernel: centre and shape are then undefined
  glm::dvec3 fromEye{0.0};  ///< if it is cut: from the eye to the voxel's centre, in index space
  double ahead = 1.0;       ///< orthographic: the approximate part of the kernel in front of the eye plane
};

/// The contribution of a splat to a pixel.
struct CoveredPixel {
  std::size_t index;
  glm::dvec2 offset;  ///< offset of the pixel's centre from the splat's, in pixels
  double omega;  ///< line integral of the kernel in front of the eye, world length; 0 outside the footprint
  double
      ahead;  ///< for a cut kernel: world length from the eye to the point of the ray nearest to the voxel's centre
};

class SplatProjector {
 public:
  SplatProjector(const Volume& volume, const Camera& camera, glm::ivec2 imageSize);

  /// Projects a block whose kernel is centred at `place` in index space. Empty if it is not drawn because the
  /// kernel is behind the eye plane. A perspective camera's eye plane may cut voxels' kernels, but none of a
  /// coarser block.
  std::optional<ProjectedSplat> project(const Block& block, glm::dvec3 place) const;
  std::optional<ProjectedSplat> project(const Block& block) const {
    return project(block, box(block).centre());
  }
  /// Projects the voxel with this index (Volume::at).
  Block voxel(std::uint32_t index) const;
  BlockBox box(const Block& block) const { return boxOf(block, dimensions_); }

  /// The direction towards the eye, in index space and of any length, from any position in index space. At
  /// the eye itself it is opposite to the ray of the image's middle.
  glm::dvec3 toEye(glm::dvec3 position) const;
  /// World length of a lattice layer in the viewing direction.
  double layerLength(const ProjectedSplat& splat) const;
  /// The fraction of its own light that leaves a number of lattice layers in the viewing direction: (1 -
  /// exp(-x)) / x for optical depth x.
  double leaving(const ProjectedSplat& splat, double extinction, int layers = 1) const;
  /// Opacity per world length of a number of lattice layers in the viewing direction: (1 - exp(-sigma s)) /
  /// s.
  double opacity(const ProjectedSplat& splat, double extinction, int layers = 1) const;

  /// Calls `visit` for every pixel that the splat may cover.
  void forEachPixel(const ProjectedSplat& splat, const std::function<void(const CoveredPixel&)>& visit) const;
  /// World length from the eye to the centre of a voxel whose kernel is cut.
  double distanceFromEye(const ProjectedSplat& splat) const {
    return glm::length(indexToWorld_ * splat.fromEye);
  }

 private:
  glm::dvec3 rayDirection(glm::dvec2 pixel) const;
  CoveredPixel cover(const ProjectedSplat& splat, glm::ivec2 pixel) const;

  glm::ivec3 dimensions_;
  glm::ivec2 imageSize_;
  PixelRays rays_;
  /// Maps offsets from the eye in index space to (x, y, 1) times the distance; orthographic to (x, y,
  /// distance).
  glm::dmat3 toPixel_;
  glm::dmat3 indexToWorld_;
};

}  // namespace freevoxels
