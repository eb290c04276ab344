#include "apps/freevoxels/lighting_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

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

double defaultIntensity(const Light& light, const Volume& volume) {
  if (light.atInfinity) return kDefaultIrradiance;
  const glm::dvec3 size(volume.dimensions), middle = 0.5 * (size - 1.0);
  const glm::dvec3 toLight = light.place - glm::dvec3(volume.indexToWorld * glm::dvec4(middle, 1.0));
  const glm::dvec3 diagonal = 0.5 * (glm::dmat3(volume.indexToWorld) * size);
  return kDefaultIrradiance * std::max(glm::dot(toLight, toLight), glm::dot(diagonal, diagonal));
}

std::string lightText(const Light& light) {
  return fmt::format("{}={},color={},intensity={}", light.atInfinity ? "direction" : "position",
                     numberText(light.place), numberText(light.color), numberText(light.intensity));
}

}  // namespace

void LightingOptions::add(CLI::App& app) {
  const char* const group = "Light";
  app.add_option_function<std::vector<std::string>>(
         "--light",
         [this](const std::vector<std::string>& texts) {
           lights.clear();
           for (const std::string& text : texts) lights.push_back(readLight(text));
         },
         "A light, of which there may be any number: the direction from the volume towards it, or where it "
         "is "
         "in the world; its linear colour [1,1,1]; its irradiance, of a position at distance 1 "
         "[4 pi in the middle of the volume]")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("direction|position=X,Y,Z[,color=R,G,B][,intensity=I]")
      ->group(group);
  app.add_option_function<std::string>(
         "--ambient",
         [this](const std::string& text) {
           const bool one = text.find(',') == std::string::npos;
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
            "How much of the lights is scattered forwards, from -1 to 1 (Henyey and Greenstein) [0]",
            {-kMostPhaseG, kMostPhaseG})
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
  addWord(app, "--light-attenuation", kLightAttenuationWords, attenuation,
          fmt::format(
              "Whether the shadows of lights are looked up in the table, or exact, along rays that are swept "
              "once for each light: auto is exact for up to {} lights where memory is plenty, not with "
              "--attenuation nearest [auto]",
              kMostExactLights))
      ->group("Light");
  addWord(app, "--shading", kShadingWords, shading,
          "What a voxel does with lights: scatters them as fog does, or as a surface across the change of "
          "its extinction, "
          "or nothing: it sends out its colour [scatter]")
      ->group("Light");
  addNumber(app, "--surface-share", "S", surface,
            "Of --shading gradient, how much is that of a surface, from 0 to 1; the rest is as scatter [1]",
            {.minimum = 0.0, .maximum = 1.0})
      ->group("Light");
}

void LightingOptions::check() const {
  if (attenuation && lights.empty())
    fail(ExitCode::Usage,
         "--light-attenuation is how lights are shadowed, and there is none: give a --light");
  if (shading == int(Shading::Gradient) && lights.empty())
    fail(ExitCode::Usage,
         "--shading gradient is how lights are scattered, and there is none: give a --light");
  if (surface && shading != int(Shading::Gradient))
    fail(ExitCode::Usage, "--surface-share is of --shading gradient: give that as well");
  if ((environmentRotation || environmentIntensity) && !environment)
    fail(ExitCode::Usage, "{} is of an environment, and there is none: give an --environment",
         environmentRotation ? "--environment-rotation" : "--environment-intensity");
  if (tint && lights.empty() && !ambient && !environment)
    fail(ExitCode::Usage, "--extinction-tint is of the way of light, and there is none: give a --light");
  if (phaseG && lights.empty())
    fail(ExitCode::Usage, "--phase-g is how lights are scattered, and there is none: give a --light");
}

std::optional<Lighting> LightingOptions::resolve(const Volume& volume) const {
  if ((lights.empty() && !ambient && !environment) || shading == int(Shading::None)) return std::nullopt;
  Lighting lighting{.ambient = ambient.value_or(glm::dvec3(0.0)),
                    .tint = tint.value_or(glm::dvec3(1.0)),
                    .phaseG = phaseG.value_or(0.0)};
  if (shading == int(Shading::Gradient)) lighting.surface = surface.value_or(1.0);
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
  return lighting;
}

void LightingOptions::describe(OptionList& options, const std::optional<Lighting>& resolved) const {
  if (!resolved) return;
  if (attenuation)
    options.emplace_back("--light-attenuation", kLightAttenuationWords[std::size_t(*attenuation)]);
  if (shading == int(Shading::Gradient)) {
    options.emplace_back("--shading", kShadingWords[std::size_t(*shading)]);
    options.emplace_back("--surface-share", numberText(resolved->surface));
  }
  for (const Light& light : resolved->lights) options.emplace_back("--light", lightText(light));
  options.emplace_back("--ambient", numberText(resolved->ambient));
  if (resolved->environment) {
    options.emplace_back("--environment", *environment);
    options.emplace_back("--environment-rotation", numberText(resolved->environment->rotation));
    options.emplace_back("--environment-intensity", numberText(resolved->environment->intensity));
  }
  options.emplace_back("--extinction-tint", numberText(resolved->tint));
  if (!resolved->lights.empty()) options.emplace_back("--phase-g", numberText(resolved->phaseG));
}

}  // namespace freevoxels
