#pragma once
// freevoxels oracle IN OUT...

#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

class OracleCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();
  void draw() const;
  /// How many voxels there is memory for beside the picture; ExitCode::OutOfMemory where there is none.
  std::uint64_t voxelsThatFit() const;

  SceneOptions scene_;
  MessageOptions messages_;
};

}  // namespace freevoxels
