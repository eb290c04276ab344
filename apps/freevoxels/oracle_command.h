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
  /// The number of voxels that fit into memory beside the image; fails with ErrorKind::OutOfMemory if none do.
  std::uint64_t voxelsThatFit() const;

  SceneOptions scene_;
  MessageOptions messages_;
};

}  // namespace freevoxels
