#pragma once
// The light of a scene, as plain data (scene_description.h).

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// What a voxel does with light. Auto: Gradient with a transfer function and for level sets, else Scatter.
enum class Shading : int { Auto = 0, Scatter = 1, Gradient = 2 };

struct LightingDescription {
  struct GivenLight {
    Light light;
    bool hasIntensity = false;  ///< else that of defaultIntensity

    bool operator==(const GivenLight&) const = default;
  };
  /// Without lights, ambient light and environment, a key light and ambient light are chosen for the first view, dimmer for a volume
  /// with emission.
  std::vector<GivenLight> lights;
  std::optional<glm::dvec3> ambient;                                ///< radiance from everywhere, linear Rec.709, at least 0
  std::optional<std::string> environment;                           ///< an .exr (environment.h)
  std::optional<double> environmentRotation, environmentIntensity;  ///< as in Environment
  std::optional<glm::dvec3> tint;                                   ///< kMinTint to kMaxTint
  std::optional<double> phaseG;                                     ///< -kMaxPhaseG to kMaxPhaseG
  std::optional<int> scattering;                                    ///< orders, kAllOrders or 1 to kMaxOrders; else kAllOrders
  std::optional<LightAttenuation> attenuation;                      ///< else Auto
  std::optional<Shading> shading;                                   ///< else Auto
  std::optional<double> surface;                                    ///< Lighting::surface where there are surfaces, 0 to 1; else 1
  bool unlit = false;                                               ///< no lighting, whatever the other fields say

  /// Gives lights, with their intensities, in place of others.
  void take(std::span<const Light> given);
  bool hasLight() const { return !lights.empty() || ambient || environment; }
  /// Fails for fields that have no effect without others.
  void check() const;
  /// Lighting::surface for a volume of which lights are scattered so.
  double surfaceOf(const Volume& volume, const Classification& classification) const;
  /// The lighting, or nothing if unlit. Reads the environment: ErrorKind::Input.
  std::optional<Lighting> resolve(const Volume& volume, const Classification& classification, const Camera& camera) const;

  bool operator==(const LightingDescription&) const = default;
};

/// The intensity of a light that gives none: a position has kDefaultIrradiance in the middle of the volume's box, or at half its
/// diagonal from the light, whichever is farther.
double defaultIntensity(const Light& light, const Volume& volume);
/// The lights, each with its intensity.
std::vector<Light> resolvedLights(std::span<const LightingDescription::GivenLight> given, const Volume& volume);

}  // namespace freevoxels
