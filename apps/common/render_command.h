#pragma once
// freevoxels render IN... OUT...

#include "apps/common/render_options.h"
#include "apps/common/sequence_options.h"

namespace freevoxels {

class RenderCommand {
 public:
  /// `group` as RenderOptions has it.
  explicit RenderCommand(ShareGroup* group = nullptr) { options_.group = group; }
  void add(CLI::App& app);

 private:
  RenderOptions options_;
  SequenceOptions sequence_;
};

}  // namespace freevoxels
