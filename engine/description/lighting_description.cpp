#include <algorithm>
#include <numbers>

#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

/// Factor of the default lights beside emission, so that the emission shows.
constexpr double kBesideFlames = 0.4;

/// A key light from the upper left of the camera and ambient light, so that white fog is about 0.8 at its brightest for `part` 1.
Lighting defaultLights(const Camera& camera, double part) {
  constexpr double kKeyIrradiance = 2.2, kAmbientRadiance = 0.12;
  const glm::dvec3 towardsKey = glm::transpose(glm::dmat3(worldToCamera(camera))) * glm::normalize(glm::dvec3(-0.5, 0.7, 0.5));
  return {.lights = {{.place = towardsKey, .intensity = part * kKeyIrradiance * std::numbers::pi}},
          .ambient = glm::dvec3(part * kAmbientRadiance)};
}

}  // namespace

double defaultIntensity(const Light& light, const Volume& volume) {
  if (light.atInfinity) return kDefaultIrradiance;
  const glm::dvec3 size(volume.dimensions), middle = 0.5 * (size - 1.0);
  const glm::dvec3 toLight = light.place - glm::dvec3(volume.indexToWorld * glm::dvec4(middle, 1.0));
  const glm::dvec3 diagonal = 0.5 * (glm::dmat3(volume.indexToWorld) * size);
  return kDefaultIrradiance * std::max(glm::dot(toLight, toLight), glm::dot(diagonal, diagonal));
}

std::vector<Light> resolvedLights(std::span<const LightingDescription::GivenLight> given, const Volume& volume) {
  std::vector<Light> lights;
  for (const auto& [light, hasIntensity] : given) {
    lights.push_back(light);
    if (!hasIntensity) lights.back().intensity = defaultIntensity(light, volume);
  }
  return lights;
}

void LightingDescription::take(std::span<const Light> given) {
  lights.clear();
  for (const Light& light : given) lights.push_back({.light = light, .hasIntensity = true});
}

void LightingDescription::check() const {
  const bool withoutLights = lights.empty() && hasLight();
  if (attenuation && withoutLights)
    fail(ErrorKind::Usage, "{} is how lights are shadowed, and there is none: give a {}", Parameter("light-attenuation"),
         Parameter("light"));
  if (shading == Shading::Gradient && withoutLights)
    fail(ErrorKind::Usage, "{} is how lights are scattered, and there is none: give a {}", Parameter("shading", "gradient"),
         Parameter("light"));
  if (surface && shading == Shading::Scatter)
    fail(ErrorKind::Usage, "{} is of surfaces: give {} as well", Parameter("surface-share"), Parameter("shading", "gradient"));
  if ((environmentRotation || environmentIntensity) && !environment)
    fail(ErrorKind::Usage, "{} is of an environment, and there is none: give an {}",
         Parameter(environmentRotation ? "environment-rotation" : "environment-intensity"), Parameter("environment"));
}

double LightingDescription::surfaceOf(const Volume& volume, const Classification& classification) const {
  const Shading wanted = shading.value_or(Shading::Auto);
  const bool surfaces = wanted == Shading::Gradient || (wanted == Shading::Auto && (classification.transferFunction || volume.isSolid));
  return surfaces ? surface.value_or(1.0) : 0.0;
}

std::optional<Lighting> LightingDescription::resolve(const Volume& volume, const Classification& classification,
                                                 const Camera& camera) const {
  if (unlit) return std::nullopt;
  Lighting lighting;
  if (!hasLight()) lighting = defaultLights(camera, classification.emission ? kBesideFlames : 1.0);
  if (ambient) lighting.ambient = *ambient;
  lighting.tint = tint.value_or(lighting.tint);
  lighting.phaseG = phaseG.value_or(lighting.phaseG);
  lighting.scattering = scattering.value_or(kAllOrders);
  lighting.attenuation = attenuation.value_or(LightAttenuation::Auto);
  if (environment) {
    auto around = std::make_shared<Environment>(readEnvironment(*environment));
    around->rotation = environmentRotation.value_or(around->rotation);
    around->intensity = environmentIntensity.value_or(around->intensity);
    lighting.environment = std::move(around);
  }
  if (!lights.empty()) lighting.lights = resolvedLights(lights, volume);
  if (!lighting.lights.empty()) lighting.surface = surfaceOf(volume, classification);
  return lighting;
}

}  // namespace freevoxels
