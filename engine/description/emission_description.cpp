#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

void EmissionDescription::check(const InputDescription& input) const {
  if (temperatureGrid && proceduralName(input.volume))
    fail(ErrorKind::Usage, "{} chooses among the grids of a file: {} takes {} alone", Parameter("temperature-grid"), input.volume,
         Parameter("emission"));
  if (emission != false) return;
  for (const auto& [name, given] : {std::pair("temperature-grid", temperatureGrid.has_value()),
                                    {"temperature-scale", temperatureScale.has_value()},
                                    {"temperature-offset", temperatureOffset.has_value()}})
    if (given)
      fail(ErrorKind::Usage, "{} is of emission, which {} turns off: leave one of them out", Parameter(name), Parameter("emission", kNone));
}

std::optional<GridRequest> EmissionDescription::grid() const {
  if (temperatureGrid) return GridRequest{.name = *temperatureGrid, .isRequired = true};
  return emission == false ? std::nullopt : std::optional(GridRequest{.name = "", .isRequired = isAsked()});
}

bool EmissionDescription::mayShine(const TemperatureGrid& grid) const {
  return isAsked() || (emission != false && grid.isBurning && !areBelowZero(grid));
}

Emission EmissionDescription::scales(const TemperatureGrid& grid) const {
  Emission result;
  result.strength = strength.value_or(1.0);
  if (grid.isRadiance) return result;
  result.temperatureOffset = temperatureOffset.value_or(temperatureScale ? 0.0 : automaticTemperatureOffset(grid));
  result.temperatureScale = temperatureScale.value_or(automaticTemperatureScale(grid, result.temperatureOffset));
  return result;
}

bool EmissionDescription::shines(const Volume& volume) const {
  if (isAsked() || !volume.temperature || !mayShine(*volume.temperature)) return isAsked();
  return brightestLight({.emission = scales(*volume.temperature)}, volume) > 0.0;
}

std::optional<Emission> EmissionDescription::resolve(const Volume& volume,
                                                 const Classification& classification) const {
  if (temperatureGrid && volume.classification)
    fail(ErrorKind::Usage,
         "{} chooses among the grids of an OpenVDB file, and {} is a baked volume: give it to 'freevoxels bake'",
         Parameter("temperature-grid"), volume.source);
  if (emission == false) return std::nullopt;
  if (volume.classification && !isAsked()) return classification.emission;
  if (!shines(volume)) return std::nullopt;
  if (!volume.temperature)
    fail(ErrorKind::Usage, "{} has no temperatures: leave {} out, {}", volume.source, Parameter("emission"),
         volume.classification ? "or give it to 'freevoxels bake'" : "or take procedural:fire");
  Emission result = scales(*volume.temperature);
  if (!strength) result.strength = automaticEmissionStrength(volume, classification, result);
  return result;
}

void EmissionDescription::take(const Emission& resolved) {
  strength = resolved.strength;
  temperatureScale = resolved.temperatureScale;
  temperatureOffset = resolved.temperatureOffset;
}

}  // namespace freevoxels
