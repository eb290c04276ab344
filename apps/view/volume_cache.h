#pragma once
// The current volume, read once for all threads that draw it.

#include <memory>
#include <mutex>
#include <string>

#include "apps/freevoxels/scene_options.h"

namespace freevoxels {

class VolumeCache {
 public:
  explicit VolumeCache(std::uint64_t maximumVoxels) : maximumVoxels_(maximumVoxels) {}

  /// The volume that the options name was read already.
  VolumeCache(const SceneOptions& scene, std::shared_ptr<const Volume> volume);

  /// The volume that the options name, read unless it is the last one; whoever comes meanwhile waits for it.
  std::shared_ptr<const Volume> read(const SceneOptions& scene);

 private:
  const std::uint64_t maximumVoxels_;
  std::mutex mutex_;
  std::string name_;
  std::shared_ptr<const Volume> volume_;
};

}  // namespace freevoxels
