#pragma once
// The panel of lights and scattering.

#include <string>

#include "apps/view/view_state.h"

namespace freevoxels {

class LightPanel {
 public:
  void draw(ViewState& state);

 private:
  bool drawAround(LightingOptions& options);
  bool drawEnvironment(LightingOptions& options);

  std::string environment_, environmentText_;  ///< of the option, and as typed
};

}  // namespace freevoxels
