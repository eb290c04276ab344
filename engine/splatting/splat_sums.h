#pragma once
// The sums of a frame before the resolve: Subr et al. 2007, Section 4.1, Eq. 10. Sums of parts of a volume
// are added and then resolved once.

#include <glm/glm.hpp>

namespace freevoxels {

/// The sums of one pixel, with world lengths. They are additive over any partition of the voxels.
struct SplatSums {
  glm::dvec3 color{0.0};  ///< C
  double energy = 0.0;    ///< E
  double depth = 0.0;     ///< T, optical depth along the pixel's ray
  double distance = 0.0;  ///< sum of e_v times the voxel's distance along the viewing axis

  SplatSums& operator+=(const SplatSums& other) {
    color += other.color;
    energy += other.energy;
    depth += other.depth;
    distance += other.distance;
    return *this;
  }
};

}  // namespace freevoxels
