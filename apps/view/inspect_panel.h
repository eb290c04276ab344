#pragma once
// How the picture is made: table, blocks, sums, times; and another method beside it.

#include "apps/view/view_state.h"

namespace freevoxels {

void drawInspectPanel(ViewState& state);

}  // namespace freevoxels
