#pragma once
// Lights, and how a volume scatters their light: Subr et al. 2007, Section 4.3.
//
// A voxel of albedo a scatters the radiance a (sum over lights of E A phase + ambient) towards the eye. E is
// a light's irradiance at the voxel, A the transmittance between the two, and ambient the integral over all
// directions of radiance (that of the environment included) times A times phase.

#include <cmath>
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

inline constexpr int kMaxOctaves = 8;

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
  LightAttenuation attenuation = LightAttenuation::Auto;  ///< for the lights; ambient light uses the table
  /// Multiple scattering is approximated by octaves (Wrenninge, Kulla and Lundqvist 2013): octave i is lit as by single
  /// scattering, but with the optical depth towards the light, the phase function's g and the light itself all multiplied
  /// by scatteringScale^i. 1 octave is single scattering. Surfaces scatter in the first one only.
  int scattering = 1;           ///< octaves, 1..kMaxOctaves
  double scatteringScale = 0.5;  ///< in 0..1

  double octaveScale(int octave) const { return std::pow(scatteringScale, octave); }

  bool hasAmbient() const { return ambient != glm::dvec3(0.0) || environment; }
  /// Whether a frame needs the attenuation table. For Auto this only holds after it has been resolved.
  bool readsTable() const { return attenuation == LightAttenuation::Table || hasAmbient(); }
  bool isTinted() const { return tint != glm::dvec3(1.0); }
  bool operator==(const Lighting&) const = default;
};

/// The phase function of Henyey and Greenstein (1941), per steradian: it integrates to 1 over the sphere.
/// `cosine` is that of the angle between the directions of the light before and after scattering.
double phaseFunction(double g, double cosine);

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

/// Ambient light and environment by the directions of a table: radiance times the direction's fraction of the
/// sphere. They add up to the mean radiance over the sphere.
std::vector<glm::dvec3> directionLight(const Lighting& lighting, DirectionSet set,
                                       const glm::dmat4& indexToWorld);

}  // namespace freevoxels
