#pragma once
// A gathered frame without lights, stage by stage, on the CPU in double precision. It follows the method's description and
// shares no code with the shaders: every sample's ray is intersected with every slice of voxels, nothing is
// skipped and no ray ends early, so that it equals the device's frame for a cull threshold of 0. What lit samples read, depths towards
// lights and gradients, is here too; whether their images are right is the oracle's to judge (oracle.h).

#include <array>
#include <optional>
#include <span>
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

/// The scalars of all voxels, in intervals of the transfer function's table, for volumes whose voxels all have data.
std::vector<double> referenceScalars(const Volume& volume, const Classification& classification);

class ReferenceGather {
 public:
  /// Keeps a reference to the volume. The settings' lighting is not read.
  ReferenceGather(const Volume& volume, const Classification& classification, const Camera& camera, const FrameSettings& settings);

  const GatherLattice& lattice() const { return lattice_; }
  /// Whether coarse samples are near enough to each other for adaptive sampling (reference_refinement.h).
  bool adapts() const { return adapts_; }
  /// The levels of the octree that the frame reads.
  const DetailRule& detail() const { return detail_; }
  /// Whether voxels are classified after interpolation; the blocks of level 0 are then not read.
  bool hasScalars() const { return table_.has_value(); }

  /// Marches the ray of every sample. `blocks` are indexed by level.
  std::vector<GatherSums> samples(std::span<const GatherBlocks> blocks) const;
  /// Marches the ray at a position on the image, in pixels from its middle.
  GatherSums sumsAt(glm::dvec2 position, std::span<const GatherBlocks> blocks) const;
  glm::dvec2 positionOf(glm::ivec2 sample) const { return lattice_.first + lattice_.pitch * glm::dvec2(sample); }
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
  Ray rayThrough(glm::dvec2 position) const;
  int axisOf(glm::dvec2 position, const Ray& ray) const;
  Slab slabOf(const Ray& ray, int axis, int level) const;
  int firstVoxel(const Ray& ray, int axis, int level) const;
  void marchBlocks(GatherSums& sums, double& transmittance, const Ray& ray, const Slab& slab, const GatherBlocks& blocks) const;
  void marchScalars(GatherSums& sums, double& transmittance, const Ray& ray, const Slab& slab) const;
  /// The voxel's scalar in intervals of the transfer function's table; none without data.
  std::optional<double> scalarOf(glm::ivec3 voxel) const;
  Scalar scalarAt(const Ray& ray, const Slab& slab, int slice) const;
  Scalar scalarBetween(const Ray& ray, const Slab& slab, int number, double fraction) const;
  ScalarStretch scalarStretch(const Ray& ray, const Slab& slab, int number, const Scalar& last) const;
  glm::dvec4 blockAt(const Ray& ray, const Slab& slab, int slice, const GatherBlocks& blocks) const;
  glm::dvec4 mediumAt(double scalar) const;
  glm::dvec4 integralUpTo(double scalar) const;
  glm::dvec4 meanBetween(double from, double to) const;
  glm::dvec3 missingCovariance(glm::dvec2 position, double distance) const;
  GatherSums smoothedAt(const std::vector<GatherSums>& samples, glm::ivec2 sample) const;
  std::vector<GatherSums> resampled(const std::vector<GatherSums>& from, glm::ivec2 fromSize, int side) const;

  const Volume& volume_;
  glm::ivec2 size_;
  glm::dvec2 middle_;  ///< of the image, pixels
  PixelRays rays_;
  glm::dmat3 linear_;   ///< from index space to the world
  glm::dmat3 toPixel_;  ///< index offset -> (x t, y t, t), orthographic (x, y, t), with x and y from the image's middle
  DetailRule detail_;
  int mainAxis_ = 0;
  double quarters_ = 0.0;  ///< weight of the quarters of stretches of scalars
  GatherLattice lattice_;
  bool adapts_ = false;
  glm::dvec2 seenLow_, seenHigh_;
  std::optional<TransferTable> table_;
  std::vector<glm::vec4> texels_;  ///< texels of the transfer table, per world unit
};

}  // namespace freevoxels
