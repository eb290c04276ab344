#pragma once
// What one ray sees of the field: emission and absorption, in double precision.

#include <glm/glm.hpp>

#include "engine/reference/light_march.h"
#include "engine/reference/reference_field.h"

namespace freevoxels {

/// The points origin + t * direction with t >= 0, in index space.
struct MarchedRay {
  glm::dvec3 origin, direction;
  double worldLength = 1.0;                  ///< of `direction` in the world
  bool distance = true;                      ///< whether RaySum::distance is wanted
  glm::dvec3 worldDirection{0.0, 0.0, 1.0};  ///< of length 1; only what is lit asks for it
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
/// colour is a Gauss quadrature, exact where the colour is constant; with `light` times what is scattered of
/// that at each point. To it comes the field's own light j, the sum of T j ds. A ray ends where less than
/// 1e-7 of the light passes.
RaySum marchRay(const ReferenceField& field, const MarchedRay& ray, double step,
                const LightMarch* light = nullptr);

/// Optical depth up to t = `end`, exact; anything above 16 where it is at least that.
double marchDepth(const ReferenceField& field, const MarchedRay& ray, double end);

}  // namespace freevoxels
