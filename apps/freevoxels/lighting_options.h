#pragma once
// The lights of a picture. Without any of these options a volume is not lit: every voxel sends out its
// colour.

#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"
#include "engine/lighting/lighting.h"
#include "engine/volume/volume.h"

namespace freevoxels {

/// What --shading and --light-attenuation take, in the order of the enumerators.
enum class Shading : int { None = 0, Scatter = 1, Gradient = 2 };
inline const std::vector<std::string> kShadingWords{"none", "scatter", "gradient"};
inline const std::vector<std::string> kLightAttenuationWords{"table", "exact", "auto"};

struct LightingOptions {
  struct GivenLight {
    Light light;
    bool hasIntensity = false;
  };
  std::vector<GivenLight> lights;
  std::optional<glm::dvec3> ambient;
  std::optional<std::string> environment;
  std::optional<double> environmentRotation, environmentIntensity;
  std::optional<double> phaseG;
  std::optional<glm::dvec3> tint;
  std::optional<int> attenuation, shading;
  std::optional<double> surface;

  void add(CLI::App& app);
  /// What the oracle does not know: how a table is used, and surfaces.
  void addMethod(CLI::App& app);
  /// Before any work: options that say nothing without others (ExitCode::Usage).
  void check() const;
  /// None where nothing is lit. The intensity of a position defaults to what is kDefaultIrradiance in the
  /// middle of the volume's box, or half its diagonal away from the light, whichever is farther. Reads the
  /// environment.
  std::optional<Lighting> resolve(const Volume& volume) const;
  void describe(OptionList& options, const std::optional<Lighting>& resolved) const;
};

}  // namespace freevoxels
