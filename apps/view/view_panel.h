#pragma once
// The panel "View": camera, bookmarks, background, tone, and what is drawn over the image.

#include "apps/view/flight_panel.h"
#include "apps/view/session_store.h"
#include "apps/view/view_state.h"

namespace freevoxels {

void drawViewPanel(ViewState& state, SessionStore& store, FlightPanel& flight);

/// Adds the camera to the bookmarks of the volume.
void addBookmark(ViewState& state, SessionStore& store);

}  // namespace freevoxels
