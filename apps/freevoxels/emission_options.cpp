#include "apps/freevoxels/emission_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/volume/blackbody.h"

namespace freevoxels {

void EmissionOptions::add(CLI::App& app) {
  constexpr const char* kGroup = "Emission";
  addOptionalNumber(
      app, "--emission", "STRENGTH", emission, strength,
      fmt::format("Emission by temperature: luminance per world unit at {:g} K; without a number it must not be followed by a file "
                  "name [chosen to suit an image]",
                  kReferenceTemperature),
      {.minimum = 0.0})
      ->group(kGroup);
  addText(app, "--temperature-grid", "NAME", temperatureGrid,
          "Grid of the temperatures; turns emission on by itself [temperature, heat or flame]")
      ->group(kGroup);
  addNumber(app, "--temperature-scale", "K", temperatureScale,
            fmt::format("Kelvin per unit of the grid [1; if no value is above {:g}, the scale that makes the largest {:g} K]",
                        kLeastKelvinMaximum, kReferenceTemperature),
            {.minimum = 0.0})
      ->group(kGroup);
  addNumber(app, "--temperature-offset", "K", temperatureOffset,
            fmt::format("Kelvin at value 0 of the grid [0; with such an automatic scale {:g}]", kEmberTemperature))
      ->group(kGroup);
}

void EmissionOptions::check(const InputOptions& input) const {
  if (temperatureGrid && proceduralName(input.input))
    fail(ErrorKind::Usage, "--temperature-grid chooses among the grids of a file: {} takes --emission alone",
         input.input);
  if (grid()) return;
  for (const auto& [name, given] :
       {std::pair("--temperature-scale", temperatureScale), {"--temperature-offset", temperatureOffset}})
    if (given) fail(ErrorKind::Usage, "{} is of emission: add --emission or --temperature-grid NAME", name);
}

std::optional<std::string> EmissionOptions::grid() const {
  if (temperatureGrid) return temperatureGrid;
  return emission ? std::optional<std::string>("") : std::nullopt;
}

std::optional<Emission> EmissionOptions::resolve(const Volume& volume,
                                                 const Classification& classification) const {
  if (temperatureGrid && volume.classification)
    fail(ErrorKind::Usage,
         "--temperature-grid chooses among the grids of an OpenVDB file, and {} is a baked volume: give it to 'freevoxels bake'",
         volume.source);
  if (!grid()) return classification.emission;  // a baked volume's
  if (!volume.temperature)
    fail(ErrorKind::Usage, "{} has no temperatures: leave --emission out, {}", volume.source,
         volume.classification ? "or give it to 'freevoxels bake'" : "or take procedural:fire");
  const TemperatureGrid& grid = *volume.temperature;
  Emission result;
  result.temperatureOffset =
      temperatureOffset.value_or(temperatureScale ? 0.0 : automaticTemperatureOffset(grid));
  result.temperatureScale =
      temperatureScale.value_or(automaticTemperatureScale(grid, result.temperatureOffset));
  result.strength = strength ? *strength : automaticEmissionStrength(volume, classification, result);
  return result;
}

void EmissionOptions::take(const Emission& resolved) {
  strength = resolved.strength;
  temperatureScale = resolved.temperatureScale;
  temperatureOffset = resolved.temperatureOffset;
}

void EmissionOptions::describe(OptionList& options, const Volume& volume,
                               const std::optional<Emission>& resolved) const {
  if (!resolved) return;
  // A procedural volume's temperatures have no name.
  if (!volume.temperature->name.empty() && !volume.classification) options.emplace_back("--temperature-grid", volume.temperature->name);
  options.emplace_back("--emission", numberText(resolved->strength));
  options.emplace_back("--temperature-scale", numberText(resolved->temperatureScale));
  options.emplace_back("--temperature-offset", numberText(resolved->temperatureOffset));
}

void EmissionOptions::warn(const Volume& volume, const Classification& classification) {
  if (!classification.emission) return;
  const TemperatureGrid& grid = *volume.temperature;
  if (grid.nanVoxels > 0)
    spdlog::warn("{} temperature{} of {} that {} NaN or infinite count{} as 0", grid.nanVoxels,
                 grid.nanVoxels == 1 ? "" : "s", volume.source, grid.nanVoxels == 1 ? "is" : "are",
                 grid.nanVoxels == 1 ? "s" : "");
  if (classification.emission->strength > 0.0 && brightestLight(classification, volume) == 0.0)
    spdlog::warn(
        "no temperature of {} is above {:g} K, so that nothing sends out light; --temperature-scale "
        "and --temperature-grid change that",
        volume.source, kColdestLight);
}

}  // namespace freevoxels
