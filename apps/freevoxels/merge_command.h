#pragma once
// freevoxels merge PART.exr... OUT...

#include <string>
#include <vector>

#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

class MergeCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::vector<std::string> files_;  ///< parts, then images to write
  SceneOptions scene_;  ///< the form of the images
  MessageOptions messages_;
};

}  // namespace freevoxels
