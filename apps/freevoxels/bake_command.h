#pragma once
// freevoxels bake IN OUT.fvx

#include "apps/freevoxels/program.h"
#include "apps/freevoxels/scene_options.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

class ProgressLine;

class BakeCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();
  /// Of a volume that is held in memory, or of a procedural one that is too large for that, chunk by chunk.
  void bake(ProgressLine& line) const;
  void bakeProcedural(const std::string& name, ProgressLine& line) const;
  /// Options of the file, for a volume with this classification.
  BakeSettings settings(const Volume& volume, const Classification& classification) const;

  SceneOptions scene_;  ///< the volume and its classification; the rest stays as it is
  std::string file_;
  bool keepScalars_ = false, compress_ = false;
  MessageOptions messages_;
};

}  // namespace freevoxels
