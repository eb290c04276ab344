#pragma once
// The panels of the drawing method and of the background.

#include "apps/view/view_state.h"

namespace freevoxels {

void drawMethodPanel(ViewState& state);
void drawBackgroundPanel(ViewState& state);

}  // namespace freevoxels
