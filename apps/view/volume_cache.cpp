#include "apps/view/volume_cache.h"

namespace freevoxels {

namespace {

/// Different for whatever is read differently.
std::string nameOf(const SceneOptions& scene) {
  OptionList options;
  scene.input.describe(options);
  options.emplace_back("temperature", scene.emission.grid().value_or("none"));
  options.emplace_back("albedo", scene.classification.albedoGrid.value_or("none"));
  return commandText(options);
}

}  // namespace

VolumeCache::VolumeCache(const SceneOptions& scene, std::shared_ptr<const Volume> volume)
    : maximumVoxels_(volume->voxelCount()), name_(nameOf(scene)), volume_(std::move(volume)) {}

std::shared_ptr<const Volume> VolumeCache::read(const SceneOptions& scene) {
  const std::lock_guard lock(mutex_);
  std::string name = nameOf(scene);
  if (!volume_ || name != name_) {
    volume_ = nullptr;  // not both at once
    volume_ = std::make_shared<const Volume>(scene.readVolume(maximumVoxels_));
    logWarnings(*volume_, false);
    name_ = std::move(name);
  }
  return volume_;
}

}  // namespace freevoxels
