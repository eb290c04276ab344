#include "apps/library/shared_volume.h"

#include <algorithm>
#include <utility>

#include "engine/storage/baked_volume.h"

namespace freevoxels {

SharedVolume::SharedVolume(Volume volume) : description_(std::make_shared<const Volume>(std::move(volume))), read_(description_) {}

SharedVolume::SharedVolume(std::shared_ptr<const fvx::FvxFile> file, std::uint64_t maximumVoxels) : file_(std::move(file)) {
  std::vector<std::string> warnings;
  finestLevel_ = levelThatFits(*file_, 0, maximumVoxels, warnings);
  Volume outline = bakedOutline(*file_, finestLevel_);
  outline.warnings = std::move(warnings);
  description_ = std::make_shared<const Volume>(std::move(outline));
}

int SharedVolume::levelFor(const SceneDescription& scene, int frames) const {
  return std::max(scene.finestLevelNeeded(file_.get(), frames), finestLevel_);
}

std::shared_ptr<const Volume> SharedVolume::read(int level, const Progress& progress) const {
  const std::lock_guard lock(mutex_);
  if (read_ && (!file_ || level == readLevel_)) return read_;
  read_ = nullptr;  // not both at once
  read_ = std::make_shared<const Volume>(readBaked(file_, level, progress));
  readLevel_ = level;
  return read_;
}

}  // namespace freevoxels
