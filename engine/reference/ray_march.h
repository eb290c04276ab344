#pragma once
// Emission and absorption along one ray through the field, in double precision.

#include <glm/glm.hpp>
#include <limits>

#include "engine/reference/light_march.h"
#include "engine/reference/reference_field.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

/// The points origin + t * direction with t >= 0, in index space.
struct MarchedRay {
  glm::dvec3 origin, direction;
  double worldLength = 1.0;                  ///< world length of `direction`
  bool distance = true;                      ///< whether to compute RaySum::distance
  double end = std::numeric_limits<double>::infinity();  ///< the largest t that marchRay() reads
  glm::dvec3 worldDirection{0.0, 0.0, 1.0};  ///< unit vector; only used with lighting
};

/// The sums along a ray, with e = T sigma ds and T the transmittance from the ray's start.
struct RaySum {
  glm::dvec3 color{0.0};  ///< sum of e times colour
  double opacity = 0.0;   ///< sum of e, which equals 1 - T at the end of the ray
  double distance = 0.0;  ///< sum of e t
};

/// Marches along a ray. `step` is the largest distance between neighbouring quadrature points, in voxels.
///
/// The opacity is exact for any step: along a ray through a cell the field is a cubic, integrated as one. The
/// colour is a Gauss quadrature, exact where the colour is constant. With `light`, the colour at each point is multiplied by the light that
/// it scatters to the eye. Emission j adds the integral of T j ds. A ray ends where less than 1e-7 of the light passes.
RaySum marchRay(const ReferenceField& field, const MarchedRay& ray, double step,
                const LightMarch* light = nullptr);

/// The largest scalar of a Post field along a ray, where voxels with data have at least half of the interpolation's weights, or the mean of
/// all over its length, weighted by that; classified, with `opacity` that over the function's unit distance. `projection` must not be None.
RaySum projectRay(const ReferenceField& field, const MarchedRay& ray, const Classification& classification, IntensityProjection projection);

/// The exact optical depth up to t = `end`; an arbitrary value above 16 if it is larger than that.
double marchDepth(const ReferenceField& field, const MarchedRay& ray, double end);

}  // namespace freevoxels
