#pragma once
// What one ray sees of the field: emission and absorption, in double precision.

#include <glm/glm.hpp>

#include "engine/reference/reference_field.h"

namespace freevoxels {

/// The points origin + t * direction with t >= 0, in index space.
struct MarchedRay {
  glm::dvec3 origin, direction;
  double worldLength = 1.0;  ///< of `direction` in the world
  bool distance = true;      ///< whether RaySum::distance is wanted
};

/// With e = T sigma ds, T the transmittance from the ray's start:
struct RaySum {
  glm::dvec3 color{0.0};  ///< sum of e times colour
  double opacity = 0.0;   ///< sum of e, which is 1 - T in the end
  double distance = 0.0;  ///< sum of e t
};

/// `step`: no two neighbouring quadrature points are further apart, in voxels.
///
/// The opacity is exact for any step: along a ray through a cell the field is a cubic, integrated as one. The
/// colour is a Gauss quadrature, exact where the colour is constant. A ray ends where less than 1e-7 of the
/// light passes.
RaySum marchRay(const ReferenceField& field, const MarchedRay& ray, double step);

}  // namespace freevoxels
