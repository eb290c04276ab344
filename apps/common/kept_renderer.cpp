#include "apps/common/kept_renderer.h"

namespace freevoxels {

FrameSettings frameSettings(const SceneDescription& description, bool depth) {
  FrameSettings settings{.size = description.camera.size, .depth = depth};
  description.method.apply(settings);
  return settings;
}

bool KeptRenderer::isFor(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description,
                         const Scene& scene) const {
  return renderer_ && source == source_ && rendererText(description, scene) == text_;
}

Renderer& KeptRenderer::get(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description, const Scene& scene,
                            const Progress& progress) {
  if (isFor(source, description, scene)) return *renderer_;
  release();
  renderer_ = std::make_unique<Renderer>(device_, scene.volumes(source), description.method.table(), progress);
  source_ = source;
  text_ = rendererText(description, scene);
  isNew_ = true;
  return *renderer_;
}

std::vector<StageTime> KeptRenderer::takeTimings() {
  if (!renderer_) return {};
  return std::exchange(isNew_, false) ? renderer_->timings() : renderer_->frameTimings();
}

}  // namespace freevoxels
