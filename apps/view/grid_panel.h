#pragma once
// The choice of the file's grids.

#include "apps/view/grid_list.h"
#include "apps/view/view_state.h"

namespace freevoxels {

/// Draws nothing if there is no choice.
void drawGridPanel(ViewState& state, GridList& grids);

/// A choice among the grids for which `suits` is true. The first word stands for the default.
bool chooseGrid(const char* label, const std::vector<GridChoice>& grids, bool GridChoice::*suits,
                const char* none, std::optional<std::string>& name);

}  // namespace freevoxels
