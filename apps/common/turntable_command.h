#pragma once
// freevoxels turntable IN OUT_####.png... --frames N

#include "apps/common/render_options.h"

namespace freevoxels {

class TurntableCommand {
 public:
  /// `group` as RenderOptions has it.
  explicit TurntableCommand(ShareGroup* group = nullptr) { options_.group = group; }
  void add(CLI::App& app);

 private:
  void skipOthers(std::vector<FrameJob>& frames) const;

  RenderOptions options_;
  std::optional<std::string> range_;
  std::optional<int> ranksPerFrame_;
};

}  // namespace freevoxels
