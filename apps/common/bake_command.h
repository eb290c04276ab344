#pragma once
// freevoxels bake IN OUT.fvx

#include "apps/common/program.h"
#include "apps/common/scene_options.h"
#include "apps/common/share_group.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

class ProgressLine;

class BakeCommand {
 public:
  /// `group`: the processes that bake together, or null; lives longer.
  explicit BakeCommand(ShareGroup* group = nullptr) : group_(group) {}
  void add(CLI::App& app);

 private:
  void run();
  /// Bakes a volume that is held in memory; the others those that are too large for that, chunk by chunk.
  void bake(ProgressLine& line) const;
  void bakeProcedural(const std::string& name, ProgressLine& line) const;
  /// Does nothing and returns false where the file's volume fits into memory, or cannot be read in parts.
  bool bakeParts(ProgressLine& line) const;
  void bakeStream(const StreamedVolume& stream, const Volume& sample, const Classification& classification, ProgressLine& line) const;
  /// Options of the file, for a volume with this classification.
  BakeSettings settings(const Volume& volume, const Classification& classification) const;

  /// Fails where the processes of the group would not bake the same file.
  void agree(const std::string& content, const BakeSettings& settings) const;
  BakeTeam team() const;
  bool leads() const { return group_ == nullptr || group_->leads(); }

  ShareGroup* group_;
  SceneOptions scene_;  ///< the volume and its classification; the rest stays as it is
  std::string file_;
  bool keepScalars_ = false, compress_ = false;
  MessageOptions messages_;
};

}  // namespace freevoxels
