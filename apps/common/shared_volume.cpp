#include "apps/common/shared_volume.h"

#include <utility>

#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

SharedVolume::SharedVolume(Volume volume)
    : description_(std::make_shared<const Volume>(std::move(volume))), inMemory_(std::make_shared<const VolumeInMemory>(description_)) {}

SharedVolume::SharedVolume(std::shared_ptr<const fvx::FvxFile> file)
    : file_(std::move(file)), description_(std::make_shared<const Volume>(bakedOutline(*file_))) {}

std::shared_ptr<const VolumeSource> SharedVolume::source(const BakedNeed& need, const Progress& progress) const {
  if (file_ && !need.isRead) return bakedSource(file_, need.level, false);
  const std::lock_guard lock(mutex_);
  if (inMemory_ && (!file_ || need.level == level_)) return inMemory_;
  inMemory_ = nullptr;  // not both at once
  inMemory_ = bakedSource(file_, need.level, true, progress);
  level_ = need.level;
  return inMemory_;
}

}  // namespace freevoxels
