#pragma once
// Extinction, colour and emission of voxels. Without a transfer function a voxel has the extinction of its
// scalar. A transfer function is averaged over the voxel's cell, so that voxels represent values between
// their centres too, as in classification after interpolation: it is the mean over the six lines from the
// voxel's centre half-way to its neighbours, along which the scalar changes linearly.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The integral of a transfer function over the scalar, in intervals of equal length.
class TransferIntegral {
 public:
  TransferIntegral(const TransferFunction& function, float minimum, float maximum);

  /// Position of a scalar in the table, in intervals. Scalars beyond the range have the position of its end.
  double place(double scalar) const;
  /// The integral up to a position of extinction times colour (rgb) and of extinction (a).
  glm::dvec4 upTo(double place) const;
  double extinctionUpTo(double place) const;
  /// The means between two positions, of extinction times colour and of extinction. For two positions that
  /// hardly differ, the means of their interval.
  glm::dvec4 meanAt(double from, double to) const;
  glm::dvec4 mean(double fromScalar, double toScalar) const { return meanAt(place(fromScalar), place(toScalar)); }
  /// Whether any scalar of a range has extinction.
  bool holdsAnythingAt(double lowPlace, double highPlace) const;
  bool isOccupied(double low, double high) const { return holdsAnythingAt(place(low), place(high)); }

  static constexpr double kMinChange = 1e-3;  ///< least distance, in intervals, for which differences of the integral are used

 private:
  double lowest_ = 0.0, perScalar_ = 0.0;
  std::vector<glm::dvec4> sums_;     ///< integrals up to the beginning of each interval, and to the end of the last one
  std::vector<double> extinctions_;  ///< the last component of sums_, which is read most often
};

class VoxelClassifier {
 public:
  /// Keeps references to both arguments, which must outlive it.
  VoxelClassifier(const Classification& classification, const Volume& volume);

  /// Classifies a voxel, with its temperature and albedo. Colours of transfer functions are rounded to 9 bits
  /// a component, as they are stored.
  ClassifiedVoxel at(glm::ivec3 voxel) const;
  /// Writes the extinctions and packed colours (packed_light.h) of a brick of Volume::scalars in the brick's
  /// order, 0 where there is no extinction. Only for volumes with a transfer function.
  void classifyBrick(std::size_t brick, std::span<float> extinction, std::span<std::uint32_t> colors) const;

 private:
  float placeOf(float scalar) const;
  ClassifiedVoxel withNeighbours(float scalar, float place, const std::array<float, 6>& neighbours) const;
  ClassifiedVoxel meanOver(float place, const std::array<float, 6>& halfWay) const;

  const Classification& classification_;
  const Volume& volume_;
  std::optional<TransferIntegral> integral_;
  std::vector<float> placeOfCode_;  ///< of the volume's scalars, with a transfer function
};

}  // namespace freevoxels
