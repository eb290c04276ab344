#pragma once
// What the voxels of a volume hold. Without a transfer function that is their scalar's extinction. A transfer function
// is averaged over a voxel's cell, so that voxels say what lies between their centres too, as it does where scalars are
// classified after interpolation: the mean over the six lines from the voxel's centre half-way to its neighbours, along
// which the scalar changes linearly.

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

  /// A scalar as a number of intervals. Scalars beyond the range have the place of its end.
  double place(double scalar) const;
  /// The integral of extinction times colour (rgb) and of extinction (a), up to a place.
  glm::dvec4 upTo(double place) const;
  double extinctionUpTo(double place) const;
  /// The means between two places: of extinction times colour, and of extinction. Of two that are hardly apart, those of
  /// their interval.
  glm::dvec4 meanAt(double from, double to) const;
  glm::dvec4 mean(double fromScalar, double toScalar) const { return meanAt(place(fromScalar), place(toScalar)); }
  /// Whether some scalar of a range has extinction.
  bool holdsAnythingAt(double lowPlace, double highPlace) const;
  bool isOccupied(double low, double high) const { return holdsAnythingAt(place(low), place(high)); }

  static constexpr double kLeastChange = 1e-3;  ///< for differences of the integral to be used, intervals

 private:
  double lowest_ = 0.0, perScalar_ = 0.0;
  std::vector<glm::dvec4> sums_;     ///< up to the beginning of each interval, and to the end of the last one
  std::vector<double> extinctions_;  ///< the last component alone, which is asked for most
};

class VoxelClassifier {
 public:
  /// Keeps references to both.
  VoxelClassifier(const Classification& classification, const Volume& volume);

  /// With the voxel's temperature and albedo. Colours of transfer functions are as they are stored, in 9 bits a component.
  ClassifiedVoxel at(glm::ivec3 voxel) const;
  /// The same extinctions and packed colours (packed_light.h) of a brick of Volume::scalars, as they are in it; only of
  /// volumes with a transfer function. 0 where nothing is held.
  void classifyBrick(std::size_t brick, std::span<float> extinction, std::span<std::uint32_t> colors) const;

 private:
  float placeOf(float scalar) const;
  ClassifiedVoxel withNeighbours(float scalar, float place, const std::array<float, 6>& neighbours) const;
  ClassifiedVoxel meanOver(float place, const std::array<float, 6>& halfWay) const;

  const Classification& classification_;
  const Volume& volume_;
  std::optional<TransferIntegral> integral_;
};

}  // namespace freevoxels
