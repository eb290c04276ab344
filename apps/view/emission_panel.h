#pragma once
// Light that voxels send out by their temperature.

#include "apps/view/grid_list.h"
#include "apps/view/view_state.h"
#include "apps/view/widgets.h"

namespace freevoxels {

class EmissionPanel {
 public:
  void draw(ViewState& state, GridList& grids);

 private:
  bool drawOptions(ViewState& state, const std::vector<GridChoice>& grids);

  AutomaticSlider strength_, scale_{5.0};
};

}  // namespace freevoxels
