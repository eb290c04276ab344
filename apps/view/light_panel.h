#pragma once
// What light falls on the volume, and how it is scattered.

#include <string>

#include "apps/view/view_state.h"

namespace freevoxels {

class LightPanel {
 public:
  void draw(ViewState& state);

 private:
  bool drawAround(LightingOptions& options);
  bool drawEnvironment(LightingOptions& options);

  std::string environment_, environmentText_;  ///< of the option, and as it is typed
};

}  // namespace freevoxels
