#pragma once
// freevoxels bake IN OUT.fvx

#include "apps/common/program.h"
#include "apps/common/scene_options.h"
#include "apps/common/share_group.h"

namespace freevoxels {

class BakeCommand {
 public:
  /// `group`: the processes that bake together, or null; lives longer.
  explicit BakeCommand(ShareGroup* group = nullptr) : group_(group) {}
  void add(CLI::App& app);

 private:
  void run();
  bool leads() const { return group_ == nullptr || group_->leads(); }

  ShareGroup* group_;
  SceneOptions scene_;  ///< the volume and its classification; the rest stays as it is
  std::string file_;
  bool keepScalars_ = false, compress_ = false;
  MessageOptions messages_;
};

}  // namespace freevoxels
