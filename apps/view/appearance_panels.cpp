#include "apps/view/appearance_panels.h"

#include "apps/view/grid_panel.h"
#include "apps/view/method_panel.h"

namespace freevoxels {

void LookPanels::draw(ViewState& state) {
  drawGridPanel(state, grids_);
  classification_.draw(state);
  light_.draw(state);
  emission_.draw(state, grids_);
  drawMethodPanel(state);
  drawBackgroundPanel(state);
}

}  // namespace freevoxels
