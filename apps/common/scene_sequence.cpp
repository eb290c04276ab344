#include "apps/common/scene_sequence.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/common/background_writer.h"
#include "apps/common/frame_view.h"
#include "apps/common/output_options.h"
#include "apps/common/scene_options.h"
#include "apps/common/whole_progress.h"
#include "engine/core/error.h"
#include "engine/description/scene_fields.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

/// The keywords without those of the volume, which a frame does not have.
Json withoutInput(Json keywords) {
  for (const SceneField& field : sceneFields())
    if (field.section == "input")
      for (const std::string& name : {field.name, field.key()}) takeKey(keywords, name);
  return keywords;
}

std::optional<std::string> framesOf(const std::optional<Json>& value) {
  if (!value) return std::nullopt;
  if (value->is_number_integer()) return std::to_string(value->get<std::int64_t>());
  if (!value->is_string()) fail(ErrorKind::Usage, "{} takes A-B, A-B:STEP, A- or A, as text or a whole number", Parameter("frames"));
  return value->get<std::string>();
}

std::optional<bool> flagOf(const std::optional<Json>& value, const char* name) {
  if (!value) return std::nullopt;
  if (!value->is_boolean()) fail(ErrorKind::Usage, "{} takes true or false", Parameter(name));
  return value->get<bool>();
}

std::vector<std::string> filesOfVolumes(const NumberedVolumes& found) {
  std::vector<std::string> files;
  for (const NumberedVolume& volume : found.volumes) files.push_back(volume.file);
  return files;
}

}  // namespace

/// The keywords of a sequence, taken apart.
struct SceneSequence::Given {
  Given(std::vector<std::string> names, Json all, bool choosesDevice) : keywords(std::move(all)) {
    const std::optional<std::string> frames = framesOf(takeKey(keywords, "frames"));
    fixedView = flagOf(takeKey(keywords, "fixed-view"), "fixed-view");
    KeywordOptions options({keywords}, KeywordOptions::sections(true, choosesDevice));
    if (names.empty() && !options.scene.input.volume.empty()) names.push_back(options.scene.input.volume);
    if (names.empty())
      fail(ErrorKind::Usage, "there is no volume to draw: name files or a pattern, or give a scene with a {}", Parameter("volume"));
    found = findVolumes(names, frames);
    description = options.scene.of(found.volumes.front().file);
    description.check();
    device = options.device;
    keywords = withoutInput(std::move(keywords));
  }

  Json keywords;
  std::optional<bool> fixedView;
  SceneDescription description;
  DeviceOptions device;
  NumberedVolumes found;
};

SceneSequence::SceneSequence(std::vector<std::string> names, Json keywords, Report report, std::shared_ptr<DeviceContext> context)
    : SceneSequence(Given(std::move(names), std::move(keywords), !context), std::move(report), context) {}

SceneSequence::SceneSequence(Given given, Report report, std::shared_ptr<DeviceContext> context)
    : keywords_(std::move(given.keywords)),
      description_(std::move(given.description)),
      found_(std::move(given.found)),
      report_(std::move(report)),
      chosenContext_(std::move(context)),
      context_(chosenContext_ ? chosenContext_ : sharedContext(given.device)),
      film_(description_, filesOfVolumes(found_), given.fixedView) {
  for (const std::string& gap : found_.gaps) report_(gap, true);
}

SceneSequence::~SceneSequence() {
  if (!context_->isOfThisProcess()) (void)new std::shared_ptr<DeviceContext>(context_);
}

/// The view of the first frame that holds anything.
void SceneSequence::takeFirstView(const Progress& progress) {
  for (const std::string& input : film_.inputs()) {
    try {
      const std::shared_ptr<const VolumeSource> source = film_.read(input, 1, progress);
      Scene scene = description_.of(input).resolve(known(source));
      scene.volume = std::make_shared<const Volume>(source->outline());
      view_ = std::make_shared<const Scene>(std::move(scene));
      return;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Input) throw;  // what is wrong with a frame is said when it is drawn
    }
  }
  fail(ErrorKind::Input, "no frame of {} holds anything to draw", film_.inputs().size());
}

void SceneSequence::chooseView(const Progress& progress) {
  if (isViewChosen_) return;
  if (std::optional<FilmView> view = film_.survey(progress)) {
    report_(fmt::format("{}; change it with {}", remarkOf(*view), Parameter("fixed-view")), false);
    view_ = std::make_shared<const Scene>(std::move(view->scene));
  } else if (film_.isFilm() && film_.isFixed()) {
    takeFirstView(progress);
  }
  isViewChosen_ = true;
}

void SceneSequence::open(std::size_t frame, const Progress& progress) {
  if (renderer_ && opened_ == frame) return;
  renderer_ = nullptr;  // not two volumes at once
  const std::shared_ptr<const SharedVolume> volume =
      sharedVolume(description_.of(film_.inputs()[frame]), film_.isFilm(), film_.isSurveyed(), progress);
  for (const std::string& warning : warningsOf(volume->describe(), false)) report_(warning, true);
  if (const std::string remarks = remarksOf(volume->describe()); !remarks.empty()) report_(remarks, false);
  renderer_ = std::make_unique<SceneRenderer>(volume, keywords_, chosenContext_, view_);
  opened_ = frame;
}

Image SceneSequence::drawEmpty(const KeywordOptions& options, const Aovs& channels) {
  const glm::ivec2 size = options.scene.camera.size;
  Image image = emptyImage({.size = size, .depth = channels.needDepth()});
  const Camera seen = view_ ? filmWith(*view_, description_, options.scene).camera : Camera{};
  addChannels(image, channels, seen);
  lastFrame_.set({}, view_ ? keywordsOf(seen, size) : Json::object());
  return image;
}

Image SceneSequence::render(std::size_t frame, const KeywordOptions& options, const Aovs& channels, const Progress& progress) {
  FV_CHECK_LT(frame, found_.volumes.size());
  refuseInsideValidationLog();
  context_->refuseAfterFork();
  const FrameTurn turn(context_->turns, isDrawing_);
  double begun = 0.0;
  const Progress reading = progress ? wholeProgress([&](std::string_view stage, double fraction) {
    begun = fraction;
    progress(stage, fraction);
  })
                                    : Progress();
  try {
    const Progress paced = pacedProgress(reading);
    chooseView(paced);
    open(frame, paced);
    KeywordOptions ofFrame = options;
    ofFrame.scene.camera.holdout = holdoutOf(options.scene.camera, found_.volumes[frame].number);
    Image image = renderer_->render(ofFrame, channels, partOf(progress, begun, 1.0 - begun));
    lastFrame_.set(renderer_->timings(), renderer_->camera());
    return image;
  } catch (const EmptyVolumeError& error) {
    if (!film_.isFilm()) throw;
    report_(fmt::format("{}; it becomes an image of the background", error.text()), true);
  }
  if (progress) progress("complete", 1.0);
  return drawEmpty(options, channels);
}

/// The files of each frame.
std::vector<std::vector<std::string>> SceneSequence::filesOf(std::span<const std::string> patterns) const {
  std::vector<std::vector<std::string>> files;
  const bool isNumbered = found_.haveNumbers || film_.isFilm();
  for (const NumberedVolume& volume : found_.volumes) {
    std::vector<std::string>& own = files.emplace_back();
    for (const std::string& pattern : patterns) own.push_back(isNumbered ? frameName(pattern, volume.number) : pattern);
  }
  return files;
}

std::vector<std::string> SceneSequence::save(std::span<const std::string> patterns, const Json& output, bool skipsExisting,
                                             const Progress& progress) {
  const std::vector<std::vector<std::string>> files = filesOf(patterns);
  const std::unique_ptr<const KeywordOptions> options = read(Json::object());
  SceneDescription scene = description_;
  scene.output = KeywordOptions({output}, {"output", "scene"}).scene.output;
  std::vector<std::string> images;
  for (const std::vector<std::string>& own : files) images.insert(images.end(), own.begin(), own.end());
  if (usesStandardOutput(images)) fail(ErrorKind::Usage, "'-' is standard output, where the command line alone writes: name a file");
  checkScene(scene, images, {}, {film_.inputs().begin() + 1, film_.inputs().end()});

  BackgroundWriter writer;
  std::vector<std::string> written, problems;
  const double share = 1.0 / double(files.size());
  for (std::size_t frame = 0; frame < files.size(); ++frame) {
    std::error_code unreadable;
    const auto exists = [&](const std::string& file) { return std::filesystem::exists(file, unreadable); };
    if (skipsExisting && std::ranges::all_of(files[frame], exists)) {
      written.insert(written.end(), files[frame].begin(), files[frame].end());
      continue;
    }
    const Progress own = [&](std::string_view stage, double fraction) {
      progress(fmt::format("frame {} of {}: {}", frame + 1, files.size(), stage), share * (double(frame) + fraction));
    };
    try {
      Image image = render(frame, *options, scene.output.aovs, progress ? own : Progress());
      if (const std::string cleared = clearPixelsThatAreNoNumbers(image); !cleared.empty())
        report_(fmt::format("{}: {}", files[frame].front(), cleared), true);
      writer.start({.bytes = bytesOf(image), .write = [image = std::move(image), &output = scene.output, &own = files[frame]] {
                      writeImages(image, output, own, {.fullFloat = output.fullFloat});
                    }});
      written.insert(written.end(), files[frame].begin(), files[frame].end());
    } catch (const Error& error) {
      if (!film_.isFilm() || error.kind() != ErrorKind::Input || !isViewChosen_) throw;
      report_(error.text(), true);
      problems.push_back(error.text());
    }
  }
  writer.finish();
  if (!problems.empty())
    fail(ErrorKind::Input, "{} of {} volumes could not be drawn: {}", problems.size(), files.size(), problems.front());
  return written;
}

}  // namespace freevoxels
