#pragma once
// The part of the panel "Volume" that clips: the box and the plane.

#include "apps/view/view_state.h"

namespace freevoxels {

/// Draws nothing before there is an image.
void drawClipping(ViewState& state);

}  // namespace freevoxels
