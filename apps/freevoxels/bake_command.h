#pragma once
// freevoxels bake IN OUT.fvx

#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

class BakeCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();
  std::string provenance(const Volume& volume, const Classification& classification) const;

  SceneOptions scene_;  ///< the volume and its classification; the rest stays as it is
  std::string file_;
  bool keepScalars_ = false, compress_ = false;
  MessageOptions messages_;
};

}  // namespace freevoxels
