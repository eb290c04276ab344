#pragma once
// The 26 directions of Subr et al. 2007, Section 3.1, as a quadrature of the sphere.

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/lighting.h"

namespace freevoxels {

struct QuadratureDirection {
  glm::ivec3 step{0};    ///< to the next voxel on the way, in index space
  glm::dvec3 unit{0.0};  ///< unit vector of the step in world space
  double length = 0.0;   ///< world length of the step
  double weight = 0.0;   ///< fraction of the sphere
};

/// The directions with weights that add up to 1. For cubic voxels they are those of Lebedev's rule with 26 points (1976), which integrates
/// polynomials of degree 7 exactly. For other voxels they are the solid angles that the directions represent (directionShares), with the
/// least relative changes that make the rule exact for polynomials of degree 3; without these changes if a weight would not be positive.
std::vector<QuadratureDirection> sphereQuadrature(const glm::dmat4& indexToWorld);

/// The radiance of ambient light and environment that travels along each direction. Its mean by the weights is that over the sphere.
std::vector<glm::dvec3> surroundingRadiances(const Lighting& lighting, std::span<const QuadratureDirection> directions,
                                             const glm::dmat4& indexToWorld);

}  // namespace freevoxels
