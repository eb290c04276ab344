#pragma once
// The volumes that renderers share.

#include <cstdint>
#include <memory>
#include <mutex>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// A volume in memory; or a baked file, of which a level of detail is read when a renderer needs it, and kept until one needs another.
/// Any thread may call the member functions.
class SharedVolume {
 public:
  explicit SharedVolume(Volume volume);
  /// Uses no level of the file whose box has more than `maximumVoxels` voxels; the warnings of describe() say so.
  SharedVolume(std::shared_ptr<const fvx::FvxFile> file, std::uint64_t maximumVoxels);

  /// The volume; of a file its finest level that is used, without the values.
  const Volume& describe() const { return *description_; }
  /// The level that a frame of the scene, or the frames of a turn, are drawn of, as on the command line; 0 without a file.
  int levelFor(const SceneDescription& scene, int frames) const;
  /// Fails as readBaked does. `progress` may abandon it.
  std::shared_ptr<const Volume> read(int level, const Progress& progress = {}) const;

 private:
  const std::shared_ptr<const fvx::FvxFile> file_;  ///< null where the volume is of no baked file
  std::shared_ptr<const Volume> description_;
  int finestLevel_ = 0;
  mutable std::mutex mutex_;  ///< guards the members below
  mutable std::shared_ptr<const Volume> read_;
  mutable int readLevel_ = 0;  ///< of `read_`
};

}  // namespace freevoxels
