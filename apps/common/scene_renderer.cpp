#include "apps/common/scene_renderer.h"

#include <chrono>
#include <functional>
#include <limits>
#include <utility>

#include "apps/common/annotation.h"
#include "apps/common/frame_layers.h"
#include "apps/common/frame_view.h"
#include "apps/common/output_options.h"
#include "apps/common/program.h"
#include "apps/common/sequence.h"
#include "apps/common/whole_progress.h"
#include "engine/core/error.h"
#include "engine/description/added_volume.h"
#include "engine/description/scene_fields.h"
#include "engine/description/scene_json.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

/// Fails where a turn is asked for. The key in a section belongs to a whole scene, of which a frame is drawn.
void refuseTurn(const Json& keywords) {
  if (keywords.contains("frames"))
    fail(ErrorKind::Usage, "{} is of turntables, and this is one frame: draw a turntable, or a frame for each {}", Parameter("frames"),
         Parameter("orbit"));
}

/// Fails where colours are no numbers, of which no picture can be made.
void refuseNan(const Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (const glm::vec4& pixel = image.pixels[i]; glm::any(glm::isnan(pixel)))
      fail(ErrorKind::Input, "the image to save is no number (NaN) at row {}, column {}: replace such values first",
           i / std::size_t(image.size.x), i % std::size_t(image.size.x));
}

/// What ends the rays of a frame; null if nothing does.
std::shared_ptr<const Holdout> readHoldoutOf(CameraDescription camera, std::optional<TurnStep> step) {
  if (step)
    camera.holdout = holdoutOfTurn(camera, step->frame, step->turn.frames);
  else if (camera.holdout && isPattern(*camera.holdout))
    fail(ErrorKind::Usage, "'{}' names an image for each frame of a turn or a film, and this is one frame: name its image in {}",
         *camera.holdout, Parameter("holdout"));
  return camera.readHoldout();
}

}  // namespace

std::shared_ptr<const SharedVolume> openVolume(const std::string& file, const Json& keywords, const std::shared_ptr<DeviceContext>& context,
                                               const Progress& progress) {
  refuseTurn(keywords);
  Json named = keywords;
  if (!file.empty()) named["volume"] = file;
  const KeywordOptions options({named}, KeywordOptions::sections(true, !context));
  if (options.scene.input.volume.empty())
    fail(ErrorKind::Usage, "there is no volume to open: name a file or procedural:NAME, or give a scene with a {}", Parameter("volume"));
  options.scene.check();
  if (const std::string& volume = options.scene.input.volume; isPattern(volume))
    fail(ErrorKind::Usage, "'{}' is a sequence of volumes: draw it as a Sequence, or open one of its files", volume);
  return sharedVolume(options.scene, false, false, progress);
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

std::vector<std::string> sceneWarnings(const std::filesystem::path& file) {
  return SceneFile(file).warnings();
}

void saveScene(const std::filesystem::path& file, const Json& keywords) {
  const KeywordOptions options({keywords}, {"input", "classification", "emission", "camera", "light", "method", "output", "scene"});
  options.scene.check();
  checkOutput(file);
  writeScene(file, options.scene);
}

std::unique_ptr<const KeywordOptions> readFrame(const Json& more, const Json& own, bool choosesDevice,
                                                std::shared_ptr<const Holdout> holdout, std::optional<double> budget) {
  for (const Json* given : {&more, &own}) refuseTurn(*given);
  KeywordOptions options(std::vector{more, own}, KeywordOptions::sections(false, choosesDevice));
  options.scene.check();
  return std::make_unique<const KeywordOptions>(withFrame(std::move(options), std::move(holdout), budget));
}

KeywordOptions withFrame(KeywordOptions options, std::shared_ptr<const Holdout> holdout, std::optional<double> budget) {
  if (budget && !(*budget > 0.0 && *budget < std::numeric_limits<double>::infinity()))
    fail(ErrorKind::Usage, "{} is the time in milliseconds that a draft may take, more than 0, not {}", Parameter("budget"), *budget);
  options.holdout = std::move(holdout);
  options.budget = budget;
  return options;
}

SceneRenderer::SceneRenderer(std::shared_ptr<const SharedVolume> volume, Json keywords, std::shared_ptr<DeviceContext> context,
                             std::shared_ptr<const Scene> film)
    : volume_(std::move(volume)),
      keywords_(std::move(keywords)),
      film_(std::move(film)),
      choosesDevice_(!context),
      context_(context ? std::move(context) : sharedContext(read(Json::object())->device)),
      kept_(*context_->device) {
  own_ = read(Json::object())->scene;
  inMemory_ = volumesInMemory(own_);
}

SceneRenderer::~SceneRenderer() {
  if (context_->isOfThisProcess()) return;
  kept_.abandon();
  (void)new std::shared_ptr<DeviceContext>(context_);
}

/// Resolves scene_ as the film is seen, but for what the frame gives itself.
void SceneRenderer::resolveLikeFilm(const SceneDescription& description) {
  scene_ = description.resolveLike(filmWith(*film_, own_, description), scene_.volume);
  if (!description.method.slice) return;
  scene_.camera = sliceCameraOf(description, *film_->volume);
  if (!own_.method.slice) scene_.classification = description.resolveClassification(*scene_.volume);
}

/// Resolves scene_ for a frame, as a part of the film if there is one.
void SceneRenderer::prepare(const KeywordOptions& options, std::optional<TurnStep> step, const Progress& progress) {
  takeSource(options.scene, step, progress);
  if (film_) return resolveLikeFilm(options.scene);
  classify(options.scene);
  if (step)
    resolveTurn(options.scene, *step);
  else
    resolveView(options.scene);
}

/// Resolves camera and light of scene_ for a frame of a turn.
void SceneRenderer::resolveTurn(const SceneDescription& description, TurnStep step) {
  TurnViews& turn = step.turn;
  if (turn.ofFrames.empty()) {
    description.resolveView(scene_);
    turn.need = need_;
    turn.lighting = scene_.lighting;
    turn.ofFrames = description.views(scene_, turn.frames);
  }
  scene_.lighting = turn.lighting;
  scene_.show(turn.ofFrames[std::size_t(step.frame)]);
}

/// Resolves camera and light of scene_ for a single frame.
void SceneRenderer::resolveView(const SceneDescription& description) {
  const CameraDescription& given = description.camera;
  SceneDescription own = description;
  own.camera = own_.camera;
  own.camera.size = given.size;
  own.camera.holdout = given.holdout;
  own.camera.flight = given.flight;
  if (!given.position) own.camera.position.reset();  // an orbit has replaced it
  own.resolveView(scene_);
  if (given == own.camera || given.flight || description.method.slice) return;
  const glm::dvec2 ownAngles = own.camera.angles();
  const bool isMoved = !given.position && given.angles() != ownAngles;
  own.camera = given;
  if (isMoved) own.camera.orbit = ownAngles;  // whose distance and look-at point the frame has
  scene_.camera = own.cameras(scene_).front();
  if (isMoved) scene_.camera = movedTo(given.angles(), given.up.value_or(scene_.volume->up), scene_.camera);
}

/// Takes the level of detail that a frame needs.
void SceneRenderer::takeSource(const SceneDescription& description, std::optional<TurnStep> step, const Progress& progress) {
  const bool isKnown = step && !step->turn.ofFrames.empty();
  const BakedNeed need = isKnown ? step->turn.need : volume_->needOf(description, step ? step->turn.frames : 1);
  if (source_ && need == need_) return;
  kept_.release();  // with the volume of the source before: not both at once
  scene_.volume = nullptr;
  source_ = nullptr;
  classification_.reset();
  source_ = volume_->source(need, progress);
  scene_.volume = known(source_);
  need_ = need;
}

/// Resolves the classification of scene_ unless it is that of the frame before.
void SceneRenderer::classify(const SceneDescription& description) {
  // What surfaces reflect is a part of how volumes look.
  const std::string added = description.added.empty() ? "" : textOf(description, {"volumes", "light"});
  if (added != added_) scene_.added = openAddedVolumes(description);
  added_ = added;
  const MethodDescription& method = description.method;
  const std::string classification = fmt::format("{}{} {}", textOf(description, {"classification", "emission"}),
                                                 int(method.mode.value_or(IntensityProjection::None)), method.slice.has_value());
  if (classification == classification_) return;
  scene_.classification = description.resolveClassification(*scene_.volume);
  classification_ = classification;
}

/// Chooses the quality from what frames have taken.
void SceneRenderer::beginDraft(FrameSettings& settings, double budget) {
  if (!draft_ || draft_->milliseconds() != budget) {
    draft_ = DraftQuality(budget);
    if (lastTime_) draft_->beginFrom(lastTime_->milliseconds, lastTime_->quality);
  }
  settings.quality = draft_->quality();
  settings.scatteringCoarseness = 0;  // so that drafts and whole images share the light
  settings.allowsOldLight = settings.quality < 1.0;
}

void SceneRenderer::complete(glm::ivec2 size) {
  context_->checkValidation();
  lastFrame_.set(kept_.takeTimings(), keywordsOf(scene_.camera, size));
}

template <typename Work>
auto SceneRenderer::draw(const KeywordOptions& options, std::optional<TurnStep> step, bool depth, const Progress& progress,
                         const Work& work) {
  refuseInsideValidationLog();
  context_->refuseAfterFork();
  const FrameTurn turn(context_->turns, isDrawing_);
  const Progress whole = wholeProgress(progress);
  const SceneDescription& description = options.scene;
  FrameSettings settings = frameSettings(description, depth);
  checkFrameFits(*context_->device, settings);
  if (options.budget) beginDraft(settings, *options.budget);
  settings.holdout = options.holdout ? options.holdout : readHoldoutOf(description.camera, step);
  prepare(options, step, whole);
  settings.lighting = scene_.lighting;
  Renderer& renderer = kept_.get(source_, description, scene_, whole);
  const auto start = std::chrono::steady_clock::now();
  auto drawn = std::invoke(work, renderer, scene_.camera, settings, whole);
  lastTime_ = FrameTime{std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(), settings.quality};
  if (options.budget) draft_->took(lastTime_->milliseconds);
  if (progress) progress("complete", 1.0);
  complete(settings.size);
  return drawn;
}

/// Draws a slice, which needs no device.
Image SceneRenderer::drawSlice(const KeywordOptions& options, const Aovs& channels, const Progress& progress) {
  refuseInsideValidationLog();
  const FrameTurn turn(context_->turns, isDrawing_);
  const Progress whole = wholeProgress(progress);
  SceneDescription description = options.scene;
  description.output.aovs = channels;
  description.check();
  description.input = volume_->input();
  prepare(options, std::nullopt, whole);
  Image image = renderSlice(*source_->whole(whole), scene_, description.camera.size);
  annotate(image, description, scene_);
  if (progress) progress("complete", 1.0);
  complete(description.camera.size);
  return image;
}

Image SceneRenderer::drawImage(const KeywordOptions& options, std::optional<TurnStep> step, const Aovs& channels,
                               const Progress& progress) {
  if (step) refuseTurnOfSlice(options.scene);
  if (options.scene.method.slice) return drawSlice(options, channels, progress);
  const auto work = [&](Renderer& renderer, const Camera& camera, const FrameSettings& settings, const Progress& report) {
    Scene seen = scene_;
    seen.camera = camera;
    SceneDescription description = options.scene;
    description.input = volume_->input();
    Image image = renderFrame(renderer, *context_->device, description, seen, settings, channels, report);
    addChannels(image, channels, camera);
    annotate(image, description, seen);
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
  if (options.scene.method.slice || options.scene.method.annotate)
    fail(ErrorKind::Usage, "{} is drawn in the memory of the host: render the image there",
         Parameter(options.scene.method.slice ? "slice" : "annotate"));
  return draw(options, std::nullopt, depth, progress, &Renderer::renderOnDevice);
}

}  // namespace freevoxels
