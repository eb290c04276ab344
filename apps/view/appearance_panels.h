#pragma once
// The panels that change what a volume looks like, with what they keep from frame to frame.

#include "apps/view/classification_panel.h"
#include "apps/view/emission_panel.h"
#include "apps/view/grid_list.h"
#include "apps/view/light_panel.h"

namespace freevoxels {

class LookPanels {
 public:
  void draw(ViewState& state);
  /// For something that they show.
  bool waits() const { return classification_.waits() || grids_.isMaking(); }

 private:
  GridList grids_;
  ClassificationPanel classification_;
  LightPanel light_;
  EmissionPanel emission_;
};

}  // namespace freevoxels
