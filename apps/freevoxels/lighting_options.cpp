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
        fail(ExitCode::Usage, "--light '{}' has a direction and a position: give one of them", text);
      placed = true;
      given.light.atInfinity = key == "direction";
      given.light.place =
          triple(given.light.atInfinity ? "--light direction" : "--light position", "X,Y,Z", value);
      if (given.light.atInfinity && given.light.place == glm::dvec3(0.0))
        fail(ExitCode::Usage, "--light '{}' has the direction 0,0,0, which points nowhere: give another",
             text);
    } else if (key == "color") {
      given.light.color = triple("--light color", "R,G,B", value, {.minimum = 0.0});
    } else if (key == "intensity") {
      given.light.intensity = readNumbers("--light intensity", "I", 1, value, {.minimum = 0.0})[0];
      given.hasIntensity = true;
    } else {
      fail(ExitCode::Usage, "--light knows no '{}': it takes {}", key, kForm);
    }
  }
  if (!placed) fail(ExitCode::Usage, "--light '{}' has neither a direction nor a position: give one", text);
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

/// Of volumes that shine: for their own light to show.
constexpr double kBesideFlames = 0.4;

Lighting defaultLights(const Camera& camera, double part) {
  constexpr double kKeyIrradiance = 2.2, kAmbientRadiance = 0.12;
  const glm::dvec3 towardsKey = glm::transpose(glm::dmat3(worldToCamera(camera))) * glm::normalize(glm::dvec3(-0.5, 0.7, 0.5));
  return {.lights = {{.place = towardsKey, .intensity = part * kKeyIrradiance * std::numbers::pi}}, .ambient = glm::dvec3(part * kAmbientRadiance)};
}

void LightingOptions::add(CLI::App& app) {
  const char* const group = "Light";
  app.add_flag("--unlit", unlit, "No light: every voxel sends out its colour, whatever is around it")->group(group);
  app.add_option_function<std::vector<std::string>>(
         "--light",
         [this](const std::vector<std::string>& texts) {
           lights.clear();
           for (const std::string& text : texts) lights.push_back(readLight(text));
         },
         "A light, of which there may be any number: the direction from the volume towards it, or where it "
         "is "
         "in the world; its linear colour [1,1,1]; its irradiance, of a position at distance 1 "
         "[4 pi in the middle of the volume]. Without any light, ambient light or environment: a key light from the upper "
         "left of the first view and some ambient light, dimmer for a volume that shines")
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
         "Radiance that comes from everywhere, linear; one number is a grey [0 with lights]")
      ->take_last()
      ->type_name("R,G,B")
      ->group(group);
  addText(app, "--environment", "FILE.exr", environment,
          "Radiance by where it comes from, added to what is ambient: a lat-long picture, linear, +y up, its "
          "middle towards +z and a quarter from the left +x [none]")
      ->group(group);
  addNumber(app, "--environment-rotation", "DEG", environmentRotation,
            "Turns the environment about +y, as the azimuth of --orbit [0]")
      ->group(group);
  addNumber(app, "--environment-intensity", "I", environmentIntensity,
            "What the environment's radiance is multiplied by [1]", {.minimum = 0.0})
      ->group(group);
  addNumber(app, "--phase-g", "G", phaseG,
            "How much of the light is scattered forwards, from -1 to 1 (Henyey and Greenstein) [0]",
            {-kMostPhaseG, kMostPhaseG})
      ->group(group);
  addWholeNumber(app, "--scattering", "N", scattering,
                 fmt::format("How many orders of scattering there are: 1 is single, more brighten what light gets deep into; each "
                             "takes --scattering-scale of the one before [{}]", kDefaultScattering),
                 {1.0, double(kMostOctaves)})
      ->group(group);
  addNumber(app, "--scattering-scale", "S", scatteringScale,
            fmt::format("What optical depth towards the light, phase function's g and light are multiplied by from one order of "
                        "scattering to the next [{}]", Lighting{}.scatteringScale),
            {0.0, 1.0})
      ->group(group);
  app.add_option_function<std::string>(
         "--extinction-tint",
         [this](const std::string& text) {
           tint = triple("--extinction-tint", "R,G,B", text, {.minimum = kLeastTint, .maximum = kMostTint});
         },
         "What the extinction is multiplied by for each colour on the way of the light, so that white light "
         "turns "
         "coloured within the volume [1,1,1]")
      ->take_last()
      ->type_name("R,G,B")
      ->group(group);
}

void LightingOptions::addMethod(CLI::App& app) {
  knowsMethod = true;
  addWord(app, "--light-attenuation", kLightAttenuationWords, attenuation,
          "Whether the shadows of lights are looked up in the table, or exact, along rays that are swept once for each light: "
          "auto is exact where memory is plenty, not with --attenuation nearest [auto]")
      ->group("Light");
  addWord(app, "--shading", kShadingWords, shading,
          "What a voxel does with lights: scatters them as fog does, or as a surface across the change of its extinction; "
          "auto is as a surface with a transfer function and of level sets [auto]")
      ->group("Light");
  addNumber(app, "--surface-share", "S", surface,
            "Of surfaces, how much is scattered by them, from 0 to 1; the rest is as by fog [1]",
            {.minimum = 0.0, .maximum = 1.0})
      ->group("Light");
}

void LightingOptions::check() const {
  const bool withoutLights = lights.empty() && hasLight();
  if (attenuation && withoutLights)
    fail(ExitCode::Usage,
         "--light-attenuation is how lights are shadowed, and there is none: give a --light");
  if (shading == int(Shading::Gradient) && withoutLights)
    fail(ExitCode::Usage,
         "--shading gradient is how lights are scattered, and there is none: give a --light");
  if (surface && shading == int(Shading::Scatter))
    fail(ExitCode::Usage, "--surface-share is of surfaces: give --shading gradient as well");
  if ((environmentRotation || environmentIntensity) && !environment)
    fail(ExitCode::Usage, "{} is of an environment, and there is none: give an --environment",
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
