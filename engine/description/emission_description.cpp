#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

void EmissionDescription::check(const InputDescription& input) const {
  if (temperatureGrid && proceduralName(input.volume))
    fail(ErrorKind::Usage, "{} chooses among the grids of a file: {} takes {} alone", Parameter("temperature-grid"), input.volume,
         Parameter("emission"));
  if (grid()) return;
  for (const auto& [name, given] : {std::pair("temperature-scale", temperatureScale), {"temperature-offset", temperatureOffset}})
    if (given)
      fail(ErrorKind::Usage, "{} is of emission: add {} or {}", Parameter(name), Parameter("emission"),
           Parameter("temperature-grid", "NAME"));
}

std::optional<std::string> EmissionDescription::grid() const {
  if (temperatureGrid) return temperatureGrid;
  return emission ? std::optional<std::string>("") : std::nullopt;
}

std::optional<Emission> EmissionDescription::resolve(const Volume& volume,
                                                 const Classification& classification) const {
  if (temperatureGrid && volume.classification)
    fail(ErrorKind::Usage,
         "{} chooses among the grids of an OpenVDB file, and {} is a baked volume: give it to 'freevoxels bake'",
         Parameter("temperature-grid"), volume.source);
  if (!grid()) return classification.emission;  // a baked volume's
  if (!volume.temperature)
    fail(ErrorKind::Usage, "{} has no temperatures: leave {} out, {}", volume.source, Parameter("emission"),
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

void EmissionDescription::take(const Emission& resolved) {
  strength = resolved.strength;
  temperatureScale = resolved.temperatureScale;
  temperatureOffset = resolved.temperatureOffset;
}

}  // namespace freevoxels
