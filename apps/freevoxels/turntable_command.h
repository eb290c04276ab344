#pragma once
// freevoxels turntable IN OUT_####.png... --frames N

#include "apps/freevoxels/render_options.h"

namespace freevoxels {

class TurntableCommand {
 public:
  /// `group` as RenderOptions has it.
  explicit TurntableCommand(ShareGroup* group = nullptr) { options_.group = group; }
  void add(CLI::App& app);

 private:
  RenderOptions options_;
  std::optional<int> ranksPerFrame_;
};

}  // namespace freevoxels
