#include "apps/view/grid_panel.h"

#include <imgui.h>

#include <algorithm>

#include "apps/view/widgets.h"

namespace freevoxels {

bool chooseGrid(const char* label, const std::vector<GridChoice>& grids, bool GridChoice::*suits,
                const char* none, std::optional<std::string>& name) {
  std::vector<std::string> words{none};
  for (const GridChoice& grid : grids)
    if (grid.*suits) words.push_back(grid.name);
  const auto given = name ? std::ranges::find(words.begin() + 1, words.end(), *name) : words.begin();
  if (given == words.end()) words.push_back(*name);
  int chosen = name ? int(std::ranges::find(words.begin() + 1, words.end(), *name) - words.begin()) : 0;
  if (!choose(label, words, chosen)) return false;
  name.reset();
  if (chosen > 0) name = words[std::size_t(chosen)];
  return true;
}

void drawGridPanel(ViewState& state, GridList& grids) {
  const std::vector<GridChoice>* const all = grids.of(state.scene.input.input);
  if (!all) return;
  const bool someDensities = std::ranges::count(*all, true, &GridChoice::isDensity) > 1;
  const bool someColors = std::ranges::count(*all, true, &GridChoice::isAlbedo) > 0;
  ClassificationOptions& classification = state.scene.classification;
  const bool mayHaveColors = someColors && !classification.transferFunction;
  if ((!someDensities && !mayHaveColors) || !ImGui::CollapsingHeader("Grids")) return;
  ImGui::PushID("grids");
  const LabelRoom room;
  if (someDensities &&
      chooseGrid("grid", *all, &GridChoice::isDensity, "(automatic)", state.scene.input.grid)) {
    classification.densityScale.reset();  // that of other values
    state.changed = true;
  }
  hint("The densities, or what a transfer function is of");
  if (mayHaveColors) {
    state.changed |=
        chooseGrid("colours", *all, &GridChoice::isAlbedo, "(one colour)", classification.albedoGrid);
    hint("Albedos voxel by voxel");
  }
  ImGui::PopID();
}

}  // namespace freevoxels
