#pragma once
// The part of the panel "Volume" that clips: the box and the plane.

#include "apps/view/view_state.h"

namespace freevoxels {

/// Draws nothing where the volume cannot be clipped. `state` has a camera if it has an image.
void drawClipping(ViewState& state);

}  // namespace freevoxels
