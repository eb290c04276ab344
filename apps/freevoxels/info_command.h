#pragma once
// freevoxels info IN

#include "apps/freevoxels/input_options.h"
#include "apps/freevoxels/scene_file.h"

namespace freevoxels {

class InfoCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;
  void describeBaked() const;

  InputOptions input_;
  SceneFileOptions scene_;
  bool json_ = false, check_ = false;
};

}  // namespace freevoxels
