#pragma once
// freevoxels turntable IN OUT_####.png... --frames N

#include "apps/freevoxels/render_options.h"

namespace freevoxels {

class TurntableCommand {
 public:
  void add(CLI::App& app);

 private:
  RenderOptions options_;
  std::optional<int> frames_;
};

}  // namespace freevoxels
