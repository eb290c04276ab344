#include "apps/common/kept_renderer.h"

namespace freevoxels {

FrameSettings frameSettings(const SceneDescription& description, bool depth) {
  FrameSettings settings{.size = description.camera.size, .depth = depth};
  description.method.apply(settings);
  return settings;
}

/// Whether nothing but the transfer function of the renderer that is there may differ.
bool KeptRenderer::mayReclassify(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description,
                                 const Scene& scene) const {
  return renderer_ && source == source_ && rendererText(description, scene) == text_;
}

bool KeptRenderer::isFor(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description,
                         const Scene& scene) const {
  return mayReclassify(source, description, scene) && scene.classification == classification_;
}

Renderer& KeptRenderer::get(const std::shared_ptr<const VolumeSource>& source, const SceneDescription& description, const Scene& scene,
                            const Progress& progress) {
  if (mayReclassify(source, description, scene)) {
    if (scene.classification == classification_) return *renderer_;
    if (renderer_->reclassify(scene.classification)) {
      classification_ = scene.classification;
      return *renderer_;
    }
  }
  release();
  renderer_ = std::make_unique<Renderer>(device_, scene.volumes(source), description.method.table(), progress);
  source_ = source;
  text_ = rendererText(description, scene);
  classification_ = scene.classification;
  isNew_ = true;
  return *renderer_;
}

std::vector<StageTime> KeptRenderer::takeTimings() {
  if (!renderer_) return {};
  return std::exchange(isNew_, false) ? renderer_->timings() : renderer_->frameTimings();
}

}  // namespace freevoxels
