#pragma once
// The lights of a picture. Without any of them a key light and ambient light are chosen for the first view, unless the
// volume shines itself.

#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// What --shading and --light-attenuation take, in the order of the enumerators.
enum class Shading : int { Auto = 0, Scatter = 1, Gradient = 2 };
inline const std::vector<std::string> kShadingWords{"auto", "scatter", "gradient"};
inline const std::vector<std::string> kLightAttenuationWords{"table", "exact", "auto"};

/// Octaves of scattering where that is not given.
inline constexpr int kDefaultScattering = 3;

struct LightingOptions {
  struct GivenLight {
    Light light;
    bool hasIntensity = false;
  };
  std::vector<GivenLight> lights;
  std::optional<glm::dvec3> ambient;
  std::optional<std::string> environment;
  std::optional<double> environmentRotation, environmentIntensity;
  std::optional<double> phaseG, scatteringScale;
  std::optional<int> scattering;
  std::optional<glm::dvec3> tint;
  std::optional<int> attenuation, shading;
  std::optional<double> surface;
  bool unlit = false;  ///< whatever lights there are
  bool knowsMethod = false;  ///< addMethod() was called: else there are no surfaces

  void add(CLI::App& app);
  /// What the oracle does not know: how a table is used, and surfaces.
  void addMethod(CLI::App& app);
  /// Before any work: options that say nothing without others (ExitCode::Usage).
  void check() const;
  bool hasLight() const { return !lights.empty() || ambient || environment; }
  /// None where nothing is lit. Without lights they are defaultLights() of `camera`. The intensity of a position defaults to
  /// what is kDefaultIrradiance in the middle of the volume's box, or half its diagonal away from the light, whichever is
  /// farther. Reads the environment.
  std::optional<Lighting> resolve(const Volume& volume, const Classification& classification, const Camera& camera) const;
  void describe(OptionList& options, const std::optional<Lighting>& resolved) const;
};

/// A key light from the upper left of the camera and ambient light, so that white fog is about 0.8 at its brightest.
Lighting defaultLights(const Camera& camera);

/// Of a light whose intensity is not given.
double defaultIntensity(const Light& light, const Volume& volume);

}  // namespace freevoxels
