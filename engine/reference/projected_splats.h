#pragma once
// Voxels and blocks of them as the camera sees them, in double precision: what the references for the
// additive and for the sorted picture share.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "engine/hierarchy/hierarchy_layout.h"
#include "engine/splatting/camera.h"
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
};

class SplatProjector {
 public:
  SplatProjector(const Volume& volume, const Camera& camera, glm::ivec2 imageSize);

  /// With its kernel around `place` in index space. Empty where it is not drawn: the place is behind the eye
  /// plane (k_z <= 0), or a perspective camera's eye plane cuts the kernel (k_z² <= R² (K Kᵀ)_zz).
  std::optional<ProjectedSplat> project(const Block& block, glm::dvec3 place) const;
  std::optional<ProjectedSplat> project(const Block& block) const {
    return project(block, box(block).centre());
  }
  /// Of an index into Volume::values.
  Block voxel(std::uint32_t index) const;
  BlockBox box(const Block& block) const { return boxOf(block, dimensions_); }

  /// From a position in index space, which need not be a voxel's; index space, any length.
  glm::dvec3 toEye(glm::dvec3 position) const;
  /// World length of a lattice layer in the viewing direction.
  double layerLength(const ProjectedSplat& splat) const;
  /// Opacity of so many lattice layers in the viewing direction per world length: (1 - exp(-sigma s)) / s.
  double opacity(const ProjectedSplat& splat, double extinction, int layers = 1) const;

  /// Calls `visit` with the index of every pixel that the splat may cover, its centre's offset from the
  /// splat's, and the line integral of the kernel along that pixel's ray, in world length; 0 outside of the
  /// footprint.
  void forEachPixel(
      const ProjectedSplat& splat,
      const std::function<void(std::size_t pixel, glm::dvec2 offset, double omega)>& visit) const;

 private:
  glm::dvec3 rayDirection(glm::dvec2 pixel) const;
  double footprint(const ProjectedSplat& splat, glm::dvec2 pixel) const;

  glm::ivec3 dimensions_;
  glm::ivec2 imageSize_;
  PixelRays rays_;
  glm::dmat3 toPixel_;  ///< from the eye, index space, to (x, y, 1) times the distance; orthographic (x, y,
                        ///< distance)
  glm::dmat3 indexToWorld_;
};

}  // namespace freevoxels
