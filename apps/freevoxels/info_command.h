#pragma once
// freevoxels info IN

#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

class InfoCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();
  void describeBaked() const;

  SceneOptions scene_;  ///< the volume
  bool json_ = false, check_ = false;
};

}  // namespace freevoxels
