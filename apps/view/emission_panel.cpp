#include "apps/view/emission_panel.h"

#include <imgui.h>

#include <algorithm>

#include "apps/view/grid_panel.h"

namespace freevoxels {

namespace {

constexpr double kLeastOffset = -2000.0, kMostOffset = 4000.0;  // kelvin

}  // namespace

void EmissionPanel::draw(ViewState& state, GridList& grids) {
  const std::vector<GridChoice>* const all = grids.of(state.scene.input.input);
  if (!ImGui::CollapsingHeader("Emission") || !state.latest || !all) return;
  ImGui::PushID("emission");
  const LabelRoom room;
  EmissionOptions& options = state.scene.emission;
  const bool mayShine = all->empty() || std::ranges::any_of(*all, &GridChoice::isReal);
  bool shines = options.grid().has_value();
  if (!shines && !mayShine) {
    ImGui::TextDisabled("This file has no temperatures.");
  } else if (ImGui::Checkbox("shines by temperature", &shines)) {
    options = {};
    options.emission = shines;
    state.changed = true;
  }
  hint("As a black body: what is hot sends out light");
  if (shines) state.changed |= drawOptions(state, *all);
  ImGui::PopID();
}

bool EmissionPanel::drawOptions(ViewState& state, const std::vector<GridChoice>& grids) {
  EmissionOptions& options = state.scene.emission;
  bool changed = false;
  if (grids.size() > 1) {
    changed |= chooseGrid("temperatures", grids, &GridChoice::isReal, "(automatic)", options.temperatureGrid);
    hint("The grid of the temperatures");
  }
  const std::optional<Emission>& resolved = state.latest->scene.classification.emission;
  if (!resolved) return changed;
  const auto automatic = [](const std::optional<double>& given, double value) {
    return given ? std::nullopt : std::optional(value);
  };
  changed |= strength_.draw("strength", "Luminance per world unit at 2000 K", options.strength,
                            automatic(options.strength, resolved->strength));
  changed |= scale_.draw("K per unit", "Kelvin for each unit of the grid's values", options.temperatureScale,
                         automatic(options.temperatureScale, resolved->temperatureScale));
  if (options.temperatureScale && !options.temperatureOffset)  // which a scale of its own would make 0
    options.temperatureOffset = resolved->temperatureOffset;
  double offset = options.temperatureOffset.value_or(resolved->temperatureOffset);
  if (slide("K at 0", offset, kLeastOffset, kMostOffset, "%.0f K")) {
    options.temperatureOffset = offset;
    changed = true;
  }
  hint("Kelvin where the grid's value is 0");
  return changed;
}

}  // namespace freevoxels
