#pragma once
// freevoxels generate NAME OUT.vdb

#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

class GenerateCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::string name_, file_;
  SceneOptions scene_;  ///< the resolution
  bool list_ = false;
  MessageOptions messages_;
};

}  // namespace freevoxels
