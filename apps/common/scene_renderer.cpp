#include "apps/common/scene_renderer.h"

#include <functional>
#include <utility>

#include "apps/common/output_options.h"
#include "apps/common/program.h"
#include "apps/common/sequence.h"
#include "apps/common/whole_progress.h"
#include "engine/core/error.h"
#include "engine/description/scene_fields.h"
#include "engine/description/scene_json.h"
#include "engine/octree/volume_limits.h"
#include "engine/scene/orbit.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

/// The sections of the options of a frame, or of a file as well; of the device only where they choose it.
KeywordOptions::Sections sections(bool ofFile, bool choosesDevice) {
  std::vector<std::string> names{"classification", "emission", "camera", "light", "method", "scene"};
  if (ofFile) names.emplace_back("input");
  if (choosesDevice) names.emplace_back("device");
  return names;
}

/// Fails where a turn is asked for. The key in a section belongs to a whole scene, of which a frame is drawn.
void refuseTurn(const Json& keywords) {
  if (keywords.contains("frames"))
    fail(ErrorKind::Usage, "{} is of turntables, and this is one frame: draw a turntable, or a frame for each {}", Parameter("frames"),
         Parameter("orbit"));
}

/// The camera at another place around its look-at point, at the same distance.
Camera movedTo(glm::dvec2 orbit, glm::dvec3 up, Camera camera) {
  const double distance = glm::length(camera.position - camera.lookAt);
  camera.up = up;
  const Camera there = framingCamera({.points = {glm::dvec3(-1.0), glm::dvec3(1.0)}}, orbit.x, orbit.y, 1.0, camera);
  camera.up = there.up;
  camera.position = camera.lookAt + distance * glm::normalize(there.position - there.lookAt);
  return camera;
}

/// Fails where colours are no numbers, of which no picture can be made.
void refuseNan(const Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (const glm::vec4& pixel = image.pixels[i]; glm::any(glm::isnan(pixel)))
      fail(ErrorKind::Input, "the image to save is no number (NaN) at row {}, column {}: replace such values first",
           i / std::size_t(image.size.x), i % std::size_t(image.size.x));
}

}  // namespace

std::shared_ptr<const SharedVolume> openVolume(const std::string& file, const Json& keywords, const std::shared_ptr<DeviceContext>& context,
                                               const Progress& progress) {
  refuseTurn(keywords);
  Json named = keywords;
  if (!file.empty()) named["volume"] = file;
  const KeywordOptions options({named}, sections(true, !context));
  if (options.scene.input.volume.empty())
    fail(ErrorKind::Usage, "there is no volume to open: name a file or procedural:NAME, or give a scene with a {}", Parameter("volume"));
  options.scene.check();
  if (const std::string& volume = options.scene.input.volume; isPattern(volume))
    fail(ErrorKind::Usage, "'{}' is a sequence, which the command line alone draws: open one of its files", volume);
  if (auto baked = options.scene.input.baked()) return std::make_shared<const SharedVolume>(std::move(baked));
  return std::make_shared<const SharedVolume>(options.scene.readVolume(kMaxNumberedVoxels, 0, progress));
}

void saveImage(const std::string& file, const Image& image, const Json& keywords) {
  OutputDescription output = KeywordOptions({keywords}, {"output"}).scene.output;
  const std::span<const std::string> files(&file, 1);
  output.aovs.depth = !image.depth.empty() && isExr(file);
  if (!image.channels.empty() && !isExr(file)) fail(ErrorKind::Usage, "{} needs an .exr output", Parameter("aov"));
  if (output.aovs.position || output.aovs.normal)
    fail(ErrorKind::Usage, "an image does not know its camera, of which positions and normals are made: leave them out of {}",
         Parameter("aov"));
  if (usesStandardOutput(files)) fail(ErrorKind::Usage, "'-' is standard output, where the command line alone writes: name a file");
  checkOutputs(output, files);
  refuseNan(image);
  Image withChannels = image;
  addChannels(withChannels, output.aovs, Camera{});
  writeImages(withChannels, output, files, {.fullFloat = output.fullFloat});
}

Json loadScene(const std::filesystem::path& file) {
  // Absolute names of files, so that the scene means the same wherever it is used.
  return sceneToJson(readScene(std::filesystem::absolute(file)), std::nullopt);
}

void saveScene(const std::filesystem::path& file, const Json& keywords) {
  const KeywordOptions options({keywords}, {"input", "classification", "emission", "camera", "light", "method", "output", "scene"});
  options.scene.check();
  checkOutput(file);
  writeScene(file, options.scene);
}

/// The turn of a frame on the device, for as long as this object exists.
class SceneRenderer::Turn {
 public:
  explicit Turn(SceneRenderer& renderer) : renderer_(renderer), lock_(renderer.context_->turns) {
    if (renderer.isDrawing_)
      fail(ErrorKind::Usage,
           "a renderer cannot draw a frame in the progress function of another of its frames: use a second renderer, "
           "or draw it afterwards");
    renderer_.isDrawing_ = true;
  }
  ~Turn() { renderer_.isDrawing_ = false; }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  SceneRenderer& renderer_;
  const std::lock_guard<DrawingTurns> lock_;
};

SceneRenderer::SceneRenderer(std::shared_ptr<const SharedVolume> volume, Json keywords, std::shared_ptr<DeviceContext> context)
    : volume_(std::move(volume)),
      keywords_(std::move(keywords)),
      choosesDevice_(!context),
      context_(context ? std::move(context) : sharedContext(read(Json::object())->device)) {
  ownCamera_ = read(Json::object())->scene.camera;
}

SceneRenderer::~SceneRenderer() {
  if (context_->isOfThisProcess()) return;
  (void)renderer_.release();
  (void)new std::shared_ptr<DeviceContext>(context_);
}

std::unique_ptr<const KeywordOptions> SceneRenderer::read(const Json& more) const {
  for (const Json* given : {&more, &keywords_}) refuseTurn(*given);
  auto options = std::make_unique<KeywordOptions>(std::vector{more, keywords_}, sections(false, choosesDevice_));
  options->scene.check();
  return options;
}

/// Resolves camera and light of scene_.
void SceneRenderer::resolveView(const SceneDescription& description, std::optional<TurnStep> step) {
  if (step) {
    description.resolveView(scene_);
    scene_.camera = description.cameras(*scene_.volume, scene_.classification, step->frames)[std::size_t(step->frame)];
    return;
  }
  const CameraDescription& given = description.camera;
  SceneDescription own = description;
  own.camera = ownCamera_;
  own.camera.size = given.size;
  if (!given.position) own.camera.position.reset();  // an orbit has replaced it
  own.resolveView(scene_);
  if (given == own.camera) return;
  const glm::dvec2 ownAngles = own.camera.angles();
  const bool isMoved = !given.position && given.angles() != ownAngles;
  own.camera = given;
  if (isMoved) own.camera.orbit = ownAngles;  // whose distance and look-at point the frame has
  scene_.camera = own.cameras(*scene_.volume, scene_.classification).front();
  if (isMoved) scene_.camera = movedTo(given.angles(), given.up.value_or(scene_.volume->up), scene_.camera);
}

/// Makes renderer_ anew if the options need another one.
FrameSettings SceneRenderer::prepare(const KeywordOptions& options, std::optional<TurnStep> step, bool depth, const Progress& progress) {
  FrameSettings settings{.size = options.scene.camera.size, .depth = depth};
  options.scene.method.apply(settings);
  checkFrameFits(*context_->device, settings);
  if (const BakedNeed need = volume_->needOf(options.scene, step ? step->frames : 1); !source_ || need != need_) {
    renderer_ = nullptr;  // which has the volume of the source before: not both at once
    scene_.volume = nullptr;
    source_ = nullptr;
    source_ = volume_->source(need, progress);
    scene_.volume = known(source_);
    need_ = need;
  }
  const std::string classification = textOf(options.scene, {"classification", "emission"});
  if (!renderer_ || classification != classification_) {
    scene_.classification = options.scene.resolveClassification(*scene_.volume);
    classification_ = classification;
  }
  resolveView(options.scene, step);
  settings.lighting = scene_.lighting;
  makeRenderer(options, progress);
  return settings;
}

void SceneRenderer::makeRenderer(const KeywordOptions& options, const Progress& progress) {
  const std::string text = rendererText(options.scene, scene_);
  if (renderer_ && text == rendererText_) return;
  renderer_ = nullptr;  // so that the device never holds two
  renderer_ = std::make_unique<Renderer>(*context_->device, source_, scene_.classification, options.scene.method.table(), progress);
  rendererText_ = text;
  isRendererNew_ = true;
}

void SceneRenderer::complete(glm::ivec2 size) {
  context_->checkValidation();
  std::vector<StageTime> times = std::exchange(isRendererNew_, false) ? renderer_->timings() : renderer_->frameTimings();
  CameraDescription camera;
  camera.look(scene_.camera);
  camera.size = size;
  const std::lock_guard lock(lastFrameMutex_);
  timings_ = std::move(times);
  camera_ = camera;
}

template <typename Work>
auto SceneRenderer::draw(const KeywordOptions& options, std::optional<TurnStep> step, bool depth, const Progress& progress,
                         const Work& work) {
  refuseInsideValidationLog();
  context_->refuseAfterFork();
  const Turn turn(*this);
  const Progress whole = wholeProgress(progress);
  const FrameSettings settings = prepare(options, step, depth, whole);
  auto drawn = std::invoke(work, *renderer_, scene_.camera, settings, whole);
  if (progress) progress("complete", 1.0);
  complete(settings.size);
  return drawn;
}

Image SceneRenderer::drawImage(const KeywordOptions& options, std::optional<TurnStep> step, const Aovs& channels,
                               const Progress& progress) {
  const auto work = [&](Renderer& renderer, const Camera& camera, const FrameSettings& settings, const Progress& report) {
    Image image = renderer.render(camera, settings, report);
    addChannels(image, channels, camera);
    return image;
  };
  return draw(options, step, channels.needDepth(), progress, work);
}

Image SceneRenderer::render(const KeywordOptions& options, const Aovs& channels, const Progress& progress) {
  return drawImage(options, std::nullopt, channels, progress);
}

Image SceneRenderer::renderTurn(const KeywordOptions& options, TurnStep step, const Aovs& channels, const Progress& progress) {
  return drawImage(options, step, channels, progress);
}

std::shared_ptr<const FrameTargets> SceneRenderer::renderOnDevice(const KeywordOptions& options, bool depth, const Progress& progress) {
  return draw(options, std::nullopt, depth, progress, &Renderer::renderOnDevice);
}

std::vector<StageTime> SceneRenderer::timings() const {
  const std::lock_guard lock(lastFrameMutex_);
  return timings_;
}

nlohmann::json SceneRenderer::camera() const {
  const std::lock_guard lock(lastFrameMutex_);
  if (!camera_) return Json::object();
  const auto triple = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
  Json keywords{{"camera-position", triple(*camera_->position)}, {"look-at", triple(*camera_->lookAt)}, {"up", triple(*camera_->up)}};
  if (camera_->orthographicHeight) keywords["orthographic"] = *camera_->orthographicHeight;
  if (camera_->verticalFov) keywords["fov"] = *camera_->verticalFov;
  keywords["size"] = {camera_->size.x, camera_->size.y};
  return keywords;
}

}  // namespace freevoxels
