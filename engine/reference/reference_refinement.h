#pragma once
// Adaptive sampling of the gather's lattice (gather_roughness.comp, gather_refine.comp) in double precision.

#include <algorithm>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/gathering/gather_stages.h"

namespace freevoxels {

/// How rough the sums are at a coarse sample.
struct ReferenceRoughness {
  double color = 0.0;     ///< largest fourth difference of C and E, over the square root of the values
  double distance = 0.0;  ///< largest second difference of the mean distance, world units, times the alpha that has it

  double of(double tolerance, double distanceTolerance) const { return std::max(color, distance * tolerance / distanceTolerance); }
};

/// Refers to `samples`, the sums of all samples of the lattice, x fastest. `extent`, the number of samples along both axes, is odd.
class ReferenceRefinement {
 public:
  ReferenceRefinement(const std::vector<GatherSums>& samples, glm::ivec2 extent);

  /// The roughness of each coarse sample, x fastest.
  const std::vector<ReferenceRoughness>& roughness() const { return roughness_; }
  /// The largest roughness of the corners of the cell that has the sample; nothing for coarse samples, and for those of incomplete cells,
  /// which are marched.
  std::optional<double> roughnessOfCell(glm::ivec2 sample, double tolerance, double distanceTolerance) const;
  /// What the sample has if it is interpolated: it is not a coarse one, and its cell is complete.
  GatherSums interpolated(glm::ivec2 sample) const;

 private:
  const GatherSums& coarse(glm::ivec2 at) const;
  ReferenceRoughness roughnessAlong(glm::ivec2 at, glm::ivec2 next) const;

  const std::vector<GatherSums>& samples_;
  glm::ivec2 extent_, coarseExtent_;
  std::vector<ReferenceRoughness> roughness_;
};

}  // namespace freevoxels
