#pragma once
// Lights, and how a volume scatters their light: Subr et al. 2007, Section 4.3.
//
// A voxel of albedo a scatters the radiance a (sum over lights of E A phase + J) towards the eye. E is a light's irradiance at the voxel,
// A the transmittance between the two, and J the integral over all directions of phase times the radiance of light that was scattered
// before, comes from the surroundings or is emitted by the volume.

#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/scene/directions.h"
#include "engine/scene/environment.h"
#include "engine/scene/source_rays.h"

namespace freevoxels {

/// Default irradiance of a directional light: an unshadowed voxel then scatters as much light as it would
/// send out without lighting.
inline constexpr double kDefaultIrradiance = 4.0 * std::numbers::pi;

/// The fraction of a surface's reflected light that is in the highlight, and the highlight's exponent.
inline constexpr double kHighlight = 0.2, kHighlightExponent = 40.0;

/// Range of the extinction tint. Beyond the largest optical depth that can be encoded the transmittance is
/// unknown, which a smaller tint would make visible.
inline constexpr double kMinTint = 0.2, kMaxTint = 5.0;

/// All orders of scattering, and the largest number of them that can be asked for.
inline constexpr int kAllOrders = 0, kMaxOrders = 100;

/// Largest |g|: the narrowest phase function that 32-bit floats can represent.
inline constexpr double kMaxPhaseG = 0.99;

struct Light {
  /// A position in world space, or for a light at infinity the direction towards it, of any length but 0.
  glm::dvec3 place{0.0, 1.0, 0.0};
  bool atInfinity = true;
  glm::dvec3 color{1.0};  ///< linear Rec.709
  /// Irradiance of a surface that faces the light, to be multiplied by the colour. For a position it is the
  /// irradiance at a distance of 1 world unit; it falls with the square of the distance.
  double intensity = kDefaultIrradiance;

  bool operator==(const Light&) const = default;
};

/// How the transmittance between a light and a voxel is computed.
enum class LightAttenuation : int {
  Table = 0,  ///< looked up in the attenuation table: nothing is computed for a light
  Exact = 1,  ///< along rays from the light (source_rays.h), swept once and kept until the lights change
  Auto = 2,   ///< Exact if there is enough memory: lightAttenuationFor, planLightAttenuation
};

struct Lighting {
  std::vector<Light> lights;
  glm::dvec3 ambient{0.0};  ///< radiance from all directions, linear Rec.709
  /// Radiance by direction, added to `ambient`. May be null.
  std::shared_ptr<const Environment> environment;
  /// Factor of the extinction for each colour between a light, or the ambient light, and the point of
  /// scattering; not between that point and the eye. In kMinTint..kMaxTint.
  glm::dvec3 tint{1.0};
  /// Asymmetry g of the phase function, in -kMaxPhaseG..kMaxPhaseG: 0 scatters equally in all directions,
  /// positive values forwards.
  double phaseG = 0.0;
  /// The fraction in 0..1 of light that a voxel reflects like a surface (surfaceScattering) where the
  /// extinction changes most. The rest is scattered as by fog.
  double surface = 0.0;
  LightAttenuation attenuation = LightAttenuation::Auto;
  /// The orders of scattering that are followed (engine/lighting/scattering_solver.h): 1 is single scattering, kAllOrders as many as
  /// matter.
  int scattering = 1;

  bool hasAmbient() const { return ambient != glm::dvec3(0.0) || environment; }
  /// Whether a frame needs the attenuation table. For Auto this only holds after it has been resolved.
  bool readsTable() const { return attenuation == LightAttenuation::Table && !lights.empty(); }
  /// Whether light that was scattered before, or comes from the surroundings, reaches the medium; without its emission.
  bool hasIndirectLight() const { return hasAmbient() || (scattering != 1 && !lights.empty()); }
  bool isTinted() const { return tint != glm::dvec3(1.0); }
  bool operator==(const Lighting&) const = default;
};

/// The phase function of Henyey and Greenstein (1941), per steradian: it integrates to 1 over the sphere.
/// `cosine` is that of the angle between the directions of the light before and after scattering.
double phaseFunction(double g, double cosine);

/// For light that is scattered more than once, a phase function with a forward peak is split (delta-Eddington, Joseph, Wiscombe and Weinman
/// 1976): the fraction `forward` of what is scattered is treated as not scattered, and the rest has the asymmetry `g`.
struct PhaseSplit {
  double forward = 0.0, g = 0.0;
};
PhaseSplit splitPhase(const Lighting& lighting);

/// Replaces the phase function at a surface (after Blinn 1977): a diffuse part and a highlight of the same
/// colour, equal on both sides. It integrates to about 1 over the directions of the light. All vectors have
/// length 1; the sign of `normal` does not matter.
double surfaceScattering(glm::dvec3 normal, glm::dvec3 toLight, glm::dvec3 toEye);

/// The fraction of a voxel's light that is reflected like a surface, by the relative change of the extinction
/// from one voxel to the next.
double surfaceShare(double relativeChange);

/// The light as a source of rays, in index space.
RaySource lightSource(const Light& light, const glm::dmat4& indexToWorld);

/// For each direction of a table, in the order of directions.h, the fraction of the sphere in world space
/// that it represents under bilinear look-up. The fractions add up to 1.
std::vector<double> directionShares(DirectionSet set, const glm::dmat4& indexToWorld);

}  // namespace freevoxels
