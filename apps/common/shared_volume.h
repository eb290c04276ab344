#pragma once
// The volumes that renderers share.

#include <memory>
#include <mutex>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// A volume in memory; or a baked file, whose levels are read by the renderers that draw them, or, where a scene classifies them
/// otherwise, here, where the last one is kept for all renderers. Any thread may call the member functions.
class SharedVolume {
 public:
  explicit SharedVolume(Volume volume);
  explicit SharedVolume(std::shared_ptr<const fvx::FvxFile> file);

  /// The volume; of a file its finest level, without the values.
  const Volume& describe() const { return *description_; }

  /// What a frame of the scene needs, or the frames of a turn, as on the command line.
  BakedNeed needOf(const SceneDescription& scene, int frames) const { return file_ ? scene.needOf(*file_, frames) : BakedNeed{}; }
  /// `progress` may abandon it. Fails as readBaked does.
  std::shared_ptr<const VolumeSource> source(const BakedNeed& need, const Progress& progress) const;

 private:
  const std::shared_ptr<const fvx::FvxFile> file_;  ///< null where the volume is of no baked file
  const std::shared_ptr<const Volume> description_;
  mutable std::mutex mutex_;  ///< guards the members below
  mutable std::shared_ptr<const VolumeSource> inMemory_;
  mutable int level_ = 0;  ///< of `inMemory_`
};

}  // namespace freevoxels
