#pragma once
// A gathered frame, stage by stage, on the CPU in double precision. It follows the method's description and
// shares no code with the shaders: every sample's ray is intersected with every slice of voxels, nothing is
// skipped and no ray ends early, so that it equals the device's frame for a cull threshold of 0. Lights are those that are
// evaluated at samples: up to four with exact shadows, and ambient light without an environment. The device takes another depth towards
// a light where a ray has skipped empty blocks, so that lit frames are equal for volumes without such only.

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/gathering/gather_stages.h"
#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"
#include "engine/scene/render_settings.h"
#include "engine/visibility/detail_rule.h"
#include "engine/volume/classification.h"
#include "engine/volume/transfer_table.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The values of the blocks of a level before they are rounded for storage: extinction, extinction times colour, and emission, which is
/// part of the former or, for samples that are lit, `emissionApart`. Each is times the part of the block that is inside of the volume.
/// `albedo` is the colour of levels without their own.
GatherBlocks referenceGatherBlocks(const LevelData& medium, int level, glm::ivec3 voxels, glm::dvec3 albedo, bool emissionApart);

/// The depths towards a light of all blocks of a level, of which `extinction` has those of the voxels. Not for scalars.
std::vector<double> referenceLightDepths(const Volume& volume, std::span<const double> extinction, const LevelData& medium, int level,
                                         const Light& light);
/// Sobel's gradients, per block, of values outside of which there is nothing: 0, or if `continued` the value of the block itself.
std::vector<glm::dvec3> referenceGradients(std::span<const double> values, glm::ivec3 dimensions, bool continued);

class ReferenceGather {
 public:
  /// Keeps a reference to the volume.
  /// `scattered` is the light that ScatteringSolver finds, if there is such light.
  ReferenceGather(const Volume& volume, const Classification& classification, const Camera& camera, const FrameSettings& settings,
                  std::optional<ScatteredField> scattered = {});

  const GatherLattice& lattice() const { return lattice_; }
  /// Whether coarse samples are near enough to each other for adaptive sampling (reference_refinement.h).
  bool adapts() const { return adapts_; }
  /// The levels of the octree that the frame reads.
  const DetailRule& detail() const { return detail_; }
  /// Whether voxels are classified after interpolation; the blocks of level 0 are then not read.
  bool hasScalars() const { return table_.has_value(); }

  /// Marches the ray of every sample. `blocks` and `light` are indexed by level; without lighting `light` is not read.
  std::vector<GatherSums> samples(std::span<const GatherBlocks> blocks, std::span<const GatherLight> light) const;
  /// Marches the ray at a position on the image, in pixels from its middle.
  GatherSums sumsAt(glm::dvec2 position, std::span<const GatherBlocks> blocks, std::span<const GatherLight> light) const;
  glm::dvec2 positionOf(glm::ivec2 sample) const { return lattice_.first + lattice_.pitch * glm::dvec2(sample); }
  /// The scalars of all voxels, in intervals of the transfer function's table, for volumes whose voxels all have data.
  std::vector<double> scalars() const;
  /// Restores the round footprint, which interpolated scalars do not have.
  std::vector<GatherSums> smoothed(const std::vector<GatherSums>& samples) const;
  /// Interpolates smoothed samples, averages them over pixels and resolves. Image::depth is always computed.
  Image image(const std::vector<GatherSums>& smoothed) const;

 private:
  /// The points origin + t direction, with t the distance from the eye plane.
  struct Ray {
    glm::dvec3 origin, direction;
    double worldLength;  ///< world length of `direction`
  };
  struct Slab;
  struct Scalar;
  struct ScalarStretch;
  struct Arriving;
  struct Transmittance;
  struct Stretch;
  Ray rayThrough(glm::dvec2 position) const;
  int axisOf(glm::dvec2 position, const Ray& ray) const;
  Slab slabOf(const Ray& ray, int axis, int level) const;
  int firstVoxel(const Ray& ray, int axis, int level) const;
  void marchBlocks(GatherSums& sums, Transmittance& transmittance, const Ray& ray, const Slab& slab, const GatherBlocks& blocks) const;
  /// With `light`, what reaches the samples; null without lighting.
  void marchScalars(GatherSums& sums, Transmittance& transmittance, const Ray& ray, const Slab& slab, const GatherLight* light) const;
  /// The voxel's scalar in intervals of the transfer function's table; none without data.
  std::optional<double> scalarOf(glm::ivec3 voxel) const;
  Scalar scalarAt(const Ray& ray, const Slab& slab, int slice) const;
  ScalarStretch scalarStretch(const Ray& ray, const Slab& slab, int number, const Scalar& last) const;
  glm::dvec4 blockAt(const Ray& ray, const Slab& slab, int slice, const GatherBlocks& blocks) const;
  glm::dvec3 emissionAt(const Ray& ray, const Slab& slab, int slice, const GatherBlocks& blocks) const;
  // With lighting, in reference_gather_light.cpp:
  void marchLitBlocks(GatherSums& sums, Transmittance& transmittance, const Ray& ray, const Slab& slab, const GatherBlocks& blocks,
                      const GatherLight& light) const;
  void lightSurfaces(std::array<Stretch, 2>& halves, const GatherLight& light, const Ray& ray, const Slab& slab, int slice, double first,
                     double second) const;
  std::array<Stretch, 2> lightStretch(const GatherLight& light, const Ray& ray, const Slab& slab, const ScalarStretch& scalars,
                                      double transmittance, std::optional<Arriving>& lastArriving) const;
  void addLit(GatherSums& sums, Transmittance& before, glm::dvec4 medium, double length, double distance, const Stretch& stretch,
              const Ray& ray) const;
  glm::dvec3 leaving(const Stretch& stretch, glm::dvec3 depth, glm::dvec3 toEye) const;
  Arriving storedAt(const GatherLight& light, const Slab& slab, glm::dvec2 position, int slice) const;
  Arriving arrivingAt(const GatherLight& light, const Ray& ray, const Slab& slab, int slice) const;
  void setBeyond(Arriving& beyond, const Arriving& within, const Slab& slab, int slice) const;
  void addLayerTowards(Arriving& arriving, const Scalar& scalar, glm::dvec3 position, bool shows) const;
  std::pair<double, double> scalarNear(glm::dvec3 position) const;
  glm::dvec3 gradientAt(const GatherLight& light, const Ray& ray, const Slab& slab, int slice) const;
  void setSurface(Stretch& stretch, glm::dvec3 gradient, double decrease) const;
  void lightFromOutside(std::span<Stretch> stretches, const GatherLight& light, const Ray& ray, const Slab& slab, double slice,
                        glm::dvec3 outwards) const;
  bool isLitBorder(std::size_t light, int axis, bool first) const;
  glm::ivec3 dimensionsOf(const Slab& slab) const;
  glm::dvec4 mediumAt(double scalar) const;
  glm::dvec4 integralUpTo(double scalar) const;
  glm::dvec4 meanBetween(double from, double to) const;
  glm::dvec3 missingCovariance(glm::dvec2 position, double distance) const;
  GatherSums smoothedAt(const std::vector<GatherSums>& samples, glm::ivec2 sample) const;
  std::vector<GatherSums> resampled(const std::vector<GatherSums>& from, glm::ivec2 fromSize, int side) const;

  const Volume& volume_;
  std::optional<Lighting> lighting_;
  std::vector<RaySource> lights_;  ///< the lights' places in index space
  std::optional<ScatteredField> scattered_;
  double forward_ = 0.0;       ///< of lighting_: PhaseSplit
  glm::dvec3 deltaScale_{1.0};  ///< mean factor of the extinction that this makes towards lights
  glm::ivec2 size_;
  glm::dvec2 middle_;  ///< of the image, pixels
  PixelRays rays_;
  glm::dmat3 linear_;   ///< from index space to the world
  glm::dmat3 toPixel_;  ///< index offset -> (x t, y t, t), orthographic (x, y, t), with x and y from the image's middle
  DetailRule detail_;
  int mainAxis_ = 0;
  GatherLattice lattice_;
  bool adapts_ = false;
  glm::dvec2 seenLow_, seenHigh_;
  std::optional<TransferTable> table_;
  std::vector<glm::vec4> texels_;  ///< texels of the transfer table, per world unit
};

}  // namespace freevoxels
