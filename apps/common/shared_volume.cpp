#include "apps/common/shared_volume.h"

#include <utility>

#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

SharedVolume::SharedVolume(Volume volume)
    : description_(std::make_shared<const Volume>(std::move(volume))), source_(std::make_shared<const VolumeInMemory>(description_)) {}

SharedVolume::SharedVolume(std::shared_ptr<const fvx::FvxFile> file)
    : file_(std::move(file)), description_(std::make_shared<const Volume>(bakedOutline(*file_))) {}

std::shared_ptr<const VolumeSource> SharedVolume::sourceFor(const SceneDescription& scene, int frames, const Progress& progress) const {
  const std::lock_guard lock(mutex_);
  if (!file_) return source_;
  const int level = scene.finestLevelNeeded(file_.get(), frames);
  const bool isRead = !scene.isSeenAsBaked(*file_);
  if (source_ && level == level_ && isRead == isRead_) return source_;
  source_ = nullptr;  // not both at once
  source_ = bakedSource(file_, level, isRead, progress);
  level_ = level;
  isRead_ = isRead;
  return source_;
}

}  // namespace freevoxels
