#include "apps/library/scene_renderer.h"

#include "engine/core/error.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

const std::vector<std::string> kViewSections{"classification", "emission", "camera", "light", "method", "scene", "device"};
const std::vector<std::string> kFileSections{"input", "classification", "emission", "camera", "light", "method", "scene", "device"};
const std::vector<std::string> kOutputSections{"output"};

}  // namespace

std::shared_ptr<const Volume> openVolume(const std::string& file, const Json& keywords) {
  KeywordOptions options(keywords, kFileSections, file);
  options.scene.checkLook();
  const DeviceContext& context = deviceContext(options.device);
  return std::make_shared<const Volume>(options.scene.readVolume(maximumVoxels(*context.device)));
}

void saveImage(const std::string& file, const Image& image, const Json& keywords) {
  KeywordOptions options(keywords, kOutputSections);
  OutputOptions& output = options.scene.output;
  output.files = {file};
  output.aovs.depth = !image.depth.empty() && isExr(file);
  if (output.aovs.position || output.aovs.normal)
    fail(ErrorKind::Usage, "an image does not know its camera, of which positions and normals are made: leave them out of 'aov'");
  output.check();
  Image withChannels = image;
  addChannels(withChannels, output.aovs, Camera{});
  output.write(withChannels, {.fullFloat = output.fullFloat});
}

SceneRenderer::SceneRenderer(std::shared_ptr<const Volume> volume, Json keywords)
    : volume_(std::move(volume)), keywords_(std::move(keywords)), context_(deviceContext(read(Json::object())->device)) {}

std::unique_ptr<KeywordOptions> SceneRenderer::read(const Json& more) const {
  Json merged = keywords_;
  merged.update(more);
  auto options = std::make_unique<KeywordOptions>(merged, kViewSections);
  options->scene.input = {};  // the volume of a scene file is ignored
  options->scene.checkLook();
  return options;
}

void SceneRenderer::makeRenderer(const KeywordOptions& options, const Progress& progress) {
  scene_.volume = volume_;
  const std::string& classification = options.classificationText();
  if (!renderer_ || classification != classification_) {
    scene_.classification = options.scene.resolveClassification(*volume_);
    classification_ = classification;
  }
  options.scene.resolveView(scene_);
  const std::string text = options.scene.rendererText(scene_, options.method.table());
  if (renderer_ && text == rendererText_) return;
  renderer_ = nullptr;  // so that the device never holds two
  renderer_ = std::make_unique<Renderer>(*context_.device, *volume_, scene_.classification, options.method.table(), progress);
  rendererText_ = text;
}

Image SceneRenderer::render(const Json& more, bool depth, const Progress& progress) {
  const std::unique_ptr<const KeywordOptions> options = read(more);
  FrameSettings settings{.size = options->scene.camera.size, .depth = depth};
  options->method.apply(settings);
  const std::lock_guard lock(context_.mutex);
  checkFrameFits(*context_.device, settings);
  makeRenderer(*options, progress);
  settings.lighting = scene_.lighting;
  Image image = renderer_->render(scene_.camera, settings, progress);
  if (const std::uint64_t count = context_.instance.validationMessageCount(); count > 0)
    throw InternalError(fmt::format("{} Vulkan validation messages, printed above", count));
  return image;
}

std::vector<StageTime> SceneRenderer::timings() const {
  const std::lock_guard lock(context_.mutex);
  return renderer_ ? renderer_->timings() : std::vector<StageTime>{};
}

}  // namespace freevoxels
