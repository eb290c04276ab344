#pragma once
// The panel "Inspect": the drawing method, and how an image is made.

#include "apps/view/view_state.h"

namespace freevoxels {

void drawInspectPanel(ViewState& state);

}  // namespace freevoxels
