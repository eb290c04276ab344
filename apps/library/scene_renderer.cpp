#include "apps/library/scene_renderer.h"

#include "engine/core/error.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

const std::vector<std::string> kOutputSections{"output"};

/// The sections of the options of a frame, or of a file as well; of the device only where they choose it.
std::vector<std::string> sections(bool ofFile, bool choosesDevice) {
  std::vector<std::string> names{"classification", "emission", "camera", "light", "method", "scene"};
  if (ofFile) names.emplace_back("input");
  if (choosesDevice) names.emplace_back("device");
  return names;
}

}  // namespace

std::shared_ptr<const Volume> openVolume(const std::string& file, const Json& keywords, const std::shared_ptr<DeviceContext>& context) {
  KeywordOptions options(keywords, sections(true, !context), file);
  options.scene.checkLook();
  const std::shared_ptr<DeviceContext> used = context ? context : sharedContext(options.device);
  return std::make_shared<const Volume>(options.scene.readVolume(maximumVoxels(*used->device)));
}

void saveImage(const std::string& file, const Image& image, const Json& keywords) {
  KeywordOptions options(keywords, kOutputSections);
  OutputOptions& output = options.scene.output;
  output.files = {file};
  output.aovs.depth = !image.depth.empty() && isExr(file);
  if (output.aovs.position || output.aovs.normal)
    fail(ErrorKind::Usage, "an image does not know its camera, of which positions and normals are made: leave them out of {}", Parameter("aov"));
  output.check();
  Image withChannels = image;
  addChannels(withChannels, output.aovs, Camera{});
  output.write(withChannels, {.fullFloat = output.fullFloat});
}

SceneRenderer::SceneRenderer(std::shared_ptr<const Volume> volume, Json keywords, std::shared_ptr<DeviceContext> context)
    : volume_(std::move(volume)),
      keywords_(std::move(keywords)),
      choosesDevice_(!context),
      context_(context ? std::move(context) : sharedContext(read(Json::object())->device)) {
  if (!choosesDevice_) read(Json::object());
}

std::unique_ptr<const KeywordOptions> SceneRenderer::read(const Json& more) const {
  Json merged = keywords_;
  merged.update(more);
  auto options = std::make_unique<KeywordOptions>(merged, sections(false, choosesDevice_));
  options->scene.input = {};  // the volume of a scene file is ignored
  options->scene.checkLook();
  return options;
}

/// Makes renderer_ anew if the options need another one. The context's mutex is held.
FrameSettings SceneRenderer::prepare(const KeywordOptions& options, bool depth, const Progress& progress) {
  FrameSettings settings{.size = options.scene.camera.size, .depth = depth};
  options.method.apply(settings);
  checkFrameFits(*context_->device, settings);
  scene_.volume = volume_;
  const std::string& classification = options.classificationText();
  if (!renderer_ || classification != classification_) {
    scene_.classification = options.scene.resolveClassification(*volume_);
    classification_ = classification;
  }
  options.scene.resolveView(scene_);
  settings.lighting = scene_.lighting;
  const std::string text = options.scene.rendererText(scene_, options.method.table());
  if (renderer_ && text == rendererText_) return settings;
  renderer_ = nullptr;  // so that the device never holds two
  renderer_ = std::make_unique<Renderer>(*context_->device, *volume_, scene_.classification, options.method.table(), progress);
  rendererText_ = text;
  return settings;
}

Image SceneRenderer::render(const KeywordOptions& options, bool depth, const Progress& progress) {
  const std::lock_guard lock(context_->mutex);
  const FrameSettings settings = prepare(options, depth, progress);
  Image image = renderer_->render(scene_.camera, settings, progress);
  context_->checkValidation();
  return image;
}

std::shared_ptr<const SplatTargets> SceneRenderer::renderOnDevice(const KeywordOptions& options, bool depth,
                                                                  const Progress& progress) {
  const std::lock_guard lock(context_->mutex);
  const FrameSettings settings = prepare(options, depth, progress);
  std::shared_ptr<const SplatTargets> targets = renderer_->renderOnDevice(scene_.camera, settings, progress);
  context_->checkValidation();
  return targets;
}

std::vector<StageTime> SceneRenderer::timings() const {
  const std::lock_guard lock(context_->mutex);
  return renderer_ ? renderer_->timings() : std::vector<StageTime>{};
}

}  // namespace freevoxels
