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
  /// `input`: where the volume was read; empty for one of values in memory.
  explicit SharedVolume(Volume volume, InputDescription input = {});
  /// `isRead`: whether levels are read as a whole, however they are classified.
  explicit SharedVolume(std::shared_ptr<const fvx::FvxFile> file, bool isRead = false);

  /// The volume; of a file its finest level, without the values.
  const Volume& describe() const { return *description_; }

  const InputDescription& input() const { return input_; }

  /// What a frame of the scene needs, or the frames of a turn, as on the command line.
  BakedNeed needOf(const SceneDescription& scene, int frames) const;
  /// `progress` may abandon it. Fails as readBaked does.
  std::shared_ptr<const VolumeSource> source(const BakedNeed& need, const Progress& progress) const;

 private:
  const InputDescription input_;
  const bool isRead_ = false;
  const std::shared_ptr<const fvx::FvxFile> file_;  ///< null where the volume is of no baked file
  const std::shared_ptr<const Volume> description_;
  mutable std::mutex mutex_;  ///< guards the members below
  mutable std::shared_ptr<const VolumeSource> inMemory_;
  mutable int level_ = 0;  ///< of `inMemory_`
};

/// Opens the volume of a scene: of a film of several, whose baked files are read as a whole, or as a frame of it that may lack grids.
/// Fails as readVolume does, and for a baked file as FvxFile does. `progress` may abandon it.
std::shared_ptr<const SharedVolume> sharedVolume(const SceneDescription& scene, bool isOfFilm, bool mayLackGrids, const Progress& progress);

}  // namespace freevoxels
