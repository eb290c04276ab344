#pragma once
// How the picture is computed, and what is behind it.

#include "apps/view/view_state.h"

namespace freevoxels {

void drawMethodPanel(ViewState& state);
void drawBackgroundPanel(ViewState& state);

}  // namespace freevoxels
