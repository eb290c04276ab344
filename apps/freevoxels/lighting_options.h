#pragma once
// The options of light. Without any, a key light and ambient light are chosen for the first view, dimmer for
// a volume with emission.

#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// The words of --shading and --light-attenuation, in the order of the enumerators.
enum class Shading : int { Auto = 0, Scatter = 1, Gradient = 2 };
inline const std::vector<std::string> kShadingWords{"auto", "scatter", "gradient"};
inline const std::vector<std::string> kLightAttenuationWords{"table", "exact", "auto"};

/// Default number of orders of scattering.
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
  bool unlit = false;  ///< overrides all lights
  bool knowsMethod = false;  ///< whether addMethod() was called; otherwise there are no surfaces

  void add(CLI::App& app);
  /// Adds the options that the oracle does not have: use of the table, and surfaces.
  void addMethod(CLI::App& app);
  /// Fails with ErrorKind::Usage for options that have no effect without others. To be called before any work.
  void check() const;
  bool hasLight() const { return !lights.empty() || ambient || environment; }
  /// The lighting, or nothing without lighting. Without lights it is defaultLights() of `camera`. The default
  /// intensity of a position gives kDefaultIrradiance in the middle of the volume's box, or at half its
  /// diagonal from the light, whichever is farther. Reads the environment.
  std::optional<Lighting> resolve(const Volume& volume, const Classification& classification, const Camera& camera) const;
  void describe(OptionList& options, const std::optional<Lighting>& resolved) const;
};

/// A key light from the upper left of the camera and ambient light, so that white fog is about 0.8 at its brightest.
Lighting defaultLights(const Camera& camera);

/// The intensity of a light that gives none.
double defaultIntensity(const Light& light, const Volume& volume);

}  // namespace freevoxels
