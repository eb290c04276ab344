#include "apps/common/shared_volume.h"

#include <utility>

#include "engine/octree/volume_limits.h"
#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

SharedVolume::SharedVolume(Volume volume, InputDescription input)
    : input_(std::move(input)),
      description_(std::make_shared<const Volume>(std::move(volume))),
      inMemory_(std::make_shared<const VolumeInMemory>(description_)) {}

SharedVolume::SharedVolume(std::shared_ptr<const fvx::FvxFile> file, bool isRead)
    : isRead_(isRead), file_(std::move(file)), description_(std::make_shared<const Volume>(bakedOutline(*file_))) {}

BakedNeed SharedVolume::needOf(const SceneDescription& scene, int frames) const {
  if (!file_) return {};
  BakedNeed need = scene.needOf(*file_, frames);
  need.isRead |= isRead_;
  return need;
}

std::shared_ptr<const VolumeSource> SharedVolume::source(const BakedNeed& need, const Progress& progress) const {
  if (file_ && !need.isRead) return bakedSource(file_, need.level, false);
  const std::lock_guard lock(mutex_);
  if (inMemory_ && (!file_ || need.level == level_)) return inMemory_;
  inMemory_ = nullptr;  // not both at once
  inMemory_ = bakedSource(file_, need.level, true, progress);
  level_ = need.level;
  return inMemory_;
}

std::shared_ptr<const SharedVolume> sharedVolume(const SceneDescription& scene, bool isOfFilm, bool mayLackGrids, const Progress& progress) {
  if (auto baked = scene.input.baked()) return std::make_shared<const SharedVolume>(std::move(baked), isOfFilm);
  return std::make_shared<const SharedVolume>(scene.readVolume(kMaxNumberedVoxels, 0, progress, mayLackGrids), scene.input);
}

}  // namespace freevoxels
