#pragma once
// The panels at the window's side. Each draws into the current Dear ImGui window and sets
// ViewState::changed where it changes what is looked at.

#include <optional>
#include <string>
#include <utility>

#include "apps/view/appearance_panels.h"
#include "apps/view/view_state.h"

namespace freevoxels {

using Activity = std::optional<std::pair<std::string, double>>;

/// The current work, and errors.
void drawStatus(const ViewState& state, const Activity& activity);
void drawVolumePanel(ViewState& state);
void drawCameraPanel(ViewState& state);

/// All panels, in their order.
void drawPanelsOf(ViewState& state, const Activity& activity, LookPanels& looks);

}  // namespace freevoxels
