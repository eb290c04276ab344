#pragma once
// Which grids of a file are the volume.

#include "apps/view/grid_list.h"
#include "apps/view/view_state.h"

namespace freevoxels {

/// Nothing where there is no choice.
void drawGridPanel(ViewState& state, GridList& grids);

/// Of those grids for which `suits` is true; the first word is for what is chosen where none is given.
bool chooseGrid(const char* label, const std::vector<GridChoice>& grids, bool GridChoice::*suits,
                const char* none, std::optional<std::string>& name);

}  // namespace freevoxels
