#include "apps/freevoxels/lighting_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numbers>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr const char* kForm = "direction=X,Y,Z[,color=R,G,B][,intensity=I] or position=X,Y,Z[,...]";

glm::dvec3 triple(const char* name, const char* form, const std::string& value, NumberRange range = {}) {
  const std::vector<double> numbers = readNumbers(name, form, 3, value, range);
  return {numbers[0], numbers[1], numbers[2]};
}

LightingOptions::GivenLight readLight(const std::string& text) {
  LightingOptions::GivenLight given;
  bool placed = false;
  for (const auto& [key, value] : readKeys("--light", kForm, text)) {
    if (key == "direction" || key == "position") {
      if (placed)
        fail(ErrorKind::Usage, "--light '{}' has a direction and a position: give one of them", text);
      placed = true;
      given.light.atInfinity = key == "direction";
      given.light.place =
          triple(given.light.atInfinity ? "--light direction" : "--light position", "X,Y,Z", value);
      if (given.light.atInfinity && given.light.place == glm::dvec3(0.0))
        fail(ErrorKind::Usage, "--light '{}' has the direction 0,0,0, which points nowhere: give another",
             text);
    } else if (key == "color") {
      given.light.color = triple("--light color", "R,G,B", value, {.minimum = 0.0});
    } else if (key == "intensity") {
      given.light.intensity = readNumbers("--light intensity", "I", 1, value, {.minimum = 0.0})[0];
      given.hasIntensity = true;
    } else {
      fail(ErrorKind::Usage, "--light knows no '{}': it takes {}", key, kForm);
    }
  }
  if (!placed) fail(ErrorKind::Usage, "--light '{}' has neither a direction nor a position: give one", text);
  return given;
}

std::string lightText(const Light& light) {
  return fmt::format("{}={},color={},intensity={}", light.atInfinity ? "direction" : "position",
                     numberText(light.place), numberText(light.color), numberText(light.intensity));
}

}  // namespace

double defaultIntensity(const Light& light, const Volume& volume) {
  if (light.atInfinity) return kDefaultIrradiance;
  const glm::dvec3 size(volume.dimensions), middle = 0.5 * (size - 1.0);
  const glm::dvec3 toLight = light.place - glm::dvec3(volume.indexToWorld * glm::dvec4(middle, 1.0));
  const glm::dvec3 diagonal = 0.5 * (glm::dmat3(volume.indexToWorld) * size);
  return kDefaultIrradiance * std::max(glm::dot(toLight, toLight), glm::dot(diagonal, diagonal));
}

/// Factor of the default lights beside emission, so that the emission shows.
constexpr double kBesideFlames = 0.4;

Lighting defaultLights(const Camera& camera, double part) {
  constexpr double kKeyIrradiance = 2.2, kAmbientRadiance = 0.12;
  const glm::dvec3 towardsKey = glm::transpose(glm::dmat3(worldToCamera(camera))) * glm::normalize(glm::dvec3(-0.5, 0.7, 0.5));
  return {.lights = {{.place = towardsKey, .intensity = part * kKeyIrradiance * std::numbers::pi}}, .ambient = glm::dvec3(part * kAmbientRadiance)};
}

void LightingOptions::add(CLI::App& app) {
  const char* const group = "Light";
  app.add_flag("--unlit", unlit, "No lighting: every voxel sends out its colour")->group(group);
  app.add_option_function<std::vector<std::string>>(
         "--light",
         [this](const std::vector<std::string>& texts) {
           lights.clear();
           for (const std::string& text : texts) lights.push_back(readLight(text));
         },
         "A light; may be repeated. direction: from the volume towards a light at infinity; position: of a point light in the "
         "world; color: linear [1,1,1]; intensity: irradiance, for a position at distance 1 [4 pi in the middle of the volume]. "
         "Without any light, ambient light or environment there are a key light from the upper left of the first view and "
         "ambient light, dimmer for volumes with emission")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("direction|position=X,Y,Z[,color=R,G,B][,intensity=I]")
      ->group(group);
  app.add_option_function<std::string>(
         "--ambient",
         [this](const std::string& text) {
           const bool one = text.find(',') == std::string::npos && !namedColor(text);
           const auto numbers =
               readNumbers("--ambient", one ? "L" : "R,G,B", one ? 1 : 3, text, {.minimum = 0.0});
           ambient = one ? glm::dvec3(numbers[0]) : glm::dvec3(numbers[0], numbers[1], numbers[2]);
         },
         "Radiance from all directions, linear; one number is a grey [0 if there is another light]")
      ->take_last()
      ->type_name("R,G,B")
      ->group(group);
  addText(app, "--environment", "FILE.exr", environment,
          "Radiance by direction, added to the ambient light: a linear latitude-longitude image, +y up, its middle column "
          "towards +z, the column a quarter from the left towards +x [none]")
      ->group(group);
  addNumber(app, "--environment-rotation", "DEG", environmentRotation,
            "Rotation of the environment about +y in degrees, added to its azimuths [0]")
      ->group(group);
  addNumber(app, "--environment-intensity", "I", environmentIntensity,
            "Factor of the environment's radiance [1]", {.minimum = 0.0})
      ->group(group);
  addNumber(app, "--phase-g", "G", phaseG,
            "Asymmetry of the Henyey-Greenstein phase function, -0.99 to 0.99; positive scatters forwards [0]",
            {-kMostPhaseG, kMostPhaseG})
      ->group(group);
  addWholeNumber(app, "--scattering", "N", scattering,
                 fmt::format("Orders of scattering, 1 to 8: 1 is single scattering; each further order has --scattering-scale of the "
                             "light of the one before, which reaches deeper [{}]", kDefaultScattering),
                 {1.0, double(kMostOctaves)})
      ->group(group);
  addNumber(app, "--scattering-scale", "S", scatteringScale,
            fmt::format("Factor of optical depth towards the light, --phase-g and light from one order of scattering to the next [{}]",
                        Lighting{}.scatteringScale),
            {0.0, 1.0})
      ->group(group);
  app.add_option_function<std::string>(
         "--extinction-tint",
         [this](const std::string& text) {
           tint = triple("--extinction-tint", "R,G,B", text, {.minimum = kLeastTint, .maximum = kMostTint});
         },
         "Factor of the extinction between light and voxel for each colour, so that white light becomes coloured inside the "
         "volume [1,1,1]")
      ->take_last()
      ->type_name("R,G,B")
      ->group(group);
}

void LightingOptions::addMethod(CLI::App& app) {
  knowsMethod = true;
  addWord(app, "--light-attenuation", kLightAttenuationWords, attenuation,
          "Shadows of lights: looked up in the attenuation table, or exact, along rays that are swept once for each light; auto: "
          "exact if it takes at most a quarter of the device's memory and --attenuation is not nearest [auto]")
      ->group("Light");
  addWord(app, "--shading", kShadingWords, shading,
          "What a voxel does with light: scatter it as fog, or reflect it like a surface across the gradient; auto: gradient with a "
          "transfer function and for level sets, else scatter [auto]")
      ->group("Light");
  addNumber(app, "--surface-share", "S", surface,
            "Part of the light that surfaces reflect like surfaces, 0 to 1; the rest is scattered like fog [1]",
            {.minimum = 0.0, .maximum = 1.0})
      ->group("Light");
}

void LightingOptions::check() const {
  const bool withoutLights = lights.empty() && hasLight();
  if (attenuation && withoutLights)
    fail(ErrorKind::Usage,
         "--light-attenuation is how lights are shadowed, and there is none: give a --light");
  if (shading == int(Shading::Gradient) && withoutLights)
    fail(ErrorKind::Usage,
         "--shading gradient is how lights are scattered, and there is none: give a --light");
  if (surface && shading == int(Shading::Scatter))
    fail(ErrorKind::Usage, "--surface-share is of surfaces: give --shading gradient as well");
  if ((environmentRotation || environmentIntensity) && !environment)
    fail(ErrorKind::Usage, "{} is of an environment, and there is none: give an --environment",
         environmentRotation ? "--environment-rotation" : "--environment-intensity");
}

std::optional<Lighting> LightingOptions::resolve(const Volume& volume, const Classification& classification,
                                                 const Camera& camera) const {
  if (unlit) return std::nullopt;
  Lighting lighting;
  if (!hasLight()) lighting = defaultLights(camera, classification.emission ? kBesideFlames : 1.0);
  if (ambient) lighting.ambient = *ambient;
  lighting.tint = tint.value_or(lighting.tint);
  lighting.phaseG = phaseG.value_or(lighting.phaseG);
  lighting.scattering = scattering.value_or(kDefaultScattering);
  lighting.scatteringScale = scatteringScale.value_or(lighting.scatteringScale);
  lighting.attenuation = LightAttenuation(attenuation.value_or(int(LightAttenuation::Auto)));
  if (environment) {
    auto around = std::make_shared<Environment>(readEnvironment(*environment));
    around->rotation = environmentRotation.value_or(around->rotation);
    around->intensity = environmentIntensity.value_or(around->intensity);
    lighting.environment = std::move(around);
  }
  for (const GivenLight& given : lights) {
    lighting.lights.push_back(given.light);
    if (!given.hasIntensity) lighting.lights.back().intensity = defaultIntensity(given.light, volume);
  }
  const Shading wanted = Shading(shading.value_or(int(Shading::Auto)));
  const bool surfaces = wanted == Shading::Gradient || (wanted == Shading::Auto && (classification.transferFunction || volume.isLevelSet));
  if (surfaces && knowsMethod && !lighting.lights.empty()) lighting.surface = surface.value_or(1.0);
  return lighting;
}

void LightingOptions::describe(OptionList& options, const std::optional<Lighting>& resolved) const {
  if (!resolved) {
    options.emplace_back("--unlit", "");
    return;
  }
  if (attenuation)
    options.emplace_back("--light-attenuation", kLightAttenuationWords[std::size_t(*attenuation)]);
  if (!resolved->lights.empty() && knowsMethod) {
    options.emplace_back("--shading", kShadingWords[std::size_t(resolved->surface > 0.0 ? Shading::Gradient : Shading::Scatter)]);
    if (resolved->surface > 0.0) options.emplace_back("--surface-share", numberText(resolved->surface));
  }
  options.emplace_back("--scattering", fmt::format("{}", resolved->scattering));
  options.emplace_back("--scattering-scale", numberText(resolved->scatteringScale));
  for (const Light& light : resolved->lights) options.emplace_back("--light", lightText(light));
  options.emplace_back("--ambient", numberText(resolved->ambient));
  if (resolved->environment) {
    options.emplace_back("--environment", *environment);
    options.emplace_back("--environment-rotation", numberText(resolved->environment->rotation));
    options.emplace_back("--environment-intensity", numberText(resolved->environment->intensity));
  }
  options.emplace_back("--extinction-tint", numberText(resolved->tint));
  options.emplace_back("--phase-g", numberText(resolved->phaseG));
}

}  // namespace freevoxels
