#pragma once
// Lights, and how a volume scatters what it gets of them, once: Subr et al. 2007, Section 4.3.
//
// A voxel of albedo a sends the radiance a (sum over lights of E A phase + ambient) towards the eye, E the
// light's irradiance there, A the transmittance between the two, ambient the integral of radiance times A times
// phase over all directions, that of the environment included.

#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/scene/directions.h"
#include "engine/scene/environment.h"
#include "engine/scene/source_rays.h"

namespace freevoxels {

/// Of a directional light: what nothing shadows then scatters as much as it would send out without lights.
inline constexpr double kDefaultIrradiance = 4.0 * std::numbers::pi;

/// Of the light that surfaces scatter, what goes into the highlight; and its exponent.
inline constexpr double kHighlight = 0.2, kHighlightExponent = 40.0;

/// Where a depth ends its code nothing is known of what comes through, and a small tint shows that.
inline constexpr double kLeastTint = 0.2, kMostTint = 5.0;

inline constexpr int kMostOctaves = 8;

/// As narrow a phase function as 32-bit floats have.
inline constexpr double kMostPhaseG = 0.99;

struct Light {
  /// A position in the world, or at infinity the direction towards the light, of any length but 0.
  glm::dvec3 place{0.0, 1.0, 0.0};
  bool atInfinity = true;
  glm::dvec3 color{1.0};  ///< linear Rec.709
  /// Irradiance of a surface that faces the light; of a position at a distance of 1 world unit, from where it
  /// falls with the square of the distance. Times the colour.
  double intensity = kDefaultIrradiance;

  bool operator==(const Light&) const = default;
};

/// How much of a light reaches a voxel.
enum class LightAttenuation : int {
  Table = 0,  ///< as the table says: nothing is made for a light
  Exact = 1,  ///< along rays of its own (source_rays.h), swept once for as long as the lights stay as they are
  Auto = 2,   ///< Exact where memory is plenty: lightAttenuationFor, LightPass::resolve
};

struct Lighting {
  std::vector<Light> lights;
  glm::dvec3 ambient{0.0};  ///< radiance that comes from everywhere, linear Rec.709
  /// Radiance that depends on where it comes from, added to `ambient`; may be null.
  std::shared_ptr<const Environment> environment;
  /// What the extinction is multiplied by for each colour on the way of the light, ambient light too, up to
  /// where it is scattered; not from there to the eye. In kLeastTint..kMostTint.
  glm::dvec3 tint{1.0};
  /// Of the phase function, up to kMostPhaseG either way: 0 scatters alike in all directions, more forwards.
  double phaseG = 0.0;
  /// How much of what a voxel does to the lights it does as a piece of surface (surfaceScattering), in 0..1,
  /// where the extinction changes most; the rest as fog.
  double surface = 0.0;
  LightAttenuation attenuation = LightAttenuation::Auto;  ///< of the lights; what is ambient is the table's
  /// Multiple scattering is approximated by octaves (Wrenninge, Kulla and Lundqvist 2013): octave i is lit as by single
  /// scattering, but with the optical depth towards the light, the phase function's g and the light itself all multiplied
  /// by scatteringScale^i. 1 octave is single scattering. Surfaces scatter in the first one only.
  int scattering = 1;           ///< octaves, 1..kMostOctaves
  double scatteringScale = 0.5;  ///< in 0..1

  double octaveScale(int octave) const { return std::pow(scatteringScale, octave); }

  bool hasAmbient() const { return ambient != glm::dvec3(0.0) || environment; }
  /// Whether a frame has to have the table; of Auto only what it comes to says that.
  bool readsTable() const { return attenuation == LightAttenuation::Table || hasAmbient(); }
  bool isTinted() const { return tint != glm::dvec3(1.0); }
  bool operator==(const Lighting&) const = default;
};

/// Henyey and Greenstein 1941, per steradian: integrates to 1 over the sphere. `cosine` is that of the angle
/// between the ways of the light before and after.
double phaseFunction(double g, double cosine);

/// What takes the phase function's place at a surface, after Blinn 1977: diffuse, and a highlight of the same
/// colour. Both sides are alike. Integrates to about 1 over the lights' directions. All of length 1; `normal`
/// may be either.
double surfaceScattering(glm::dvec3 normal, glm::dvec3 toLight, glm::dvec3 toEye);

/// How much of a surface a voxel is whose extinction changes by this part of itself from one voxel to the
/// next.
double surfaceShare(double relativeChange);

/// In a volume's index space.
RaySource lightSource(const Light& light, const glm::dmat4& indexToWorld);

/// What part of the sphere around a voxel each direction of a table stands for, in the world, where it is
/// looked up bilinearly: they add up to 1. In the order of directions.h.
std::vector<double> directionShares(DirectionSet set, const glm::dmat4& indexToWorld);

/// What comes from everywhere, by the directions of a table: radiance times the direction's share. They add
/// up to the mean radiance over the sphere.
std::vector<glm::dvec3> directionLight(const Lighting& lighting, DirectionSet set,
                                       const glm::dmat4& indexToWorld);

}  // namespace freevoxels
