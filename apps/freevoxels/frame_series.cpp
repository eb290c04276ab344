#include "apps/freevoxels/frame_series.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "apps/freevoxels/failure.h"
#include "apps/freevoxels/colored_parts.h"
#include "apps/freevoxels/share_group.h"
#include "engine/memory_planner.h"
#include "engine/region_renderer.h"
#include "engine/streamed_renderer.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/content_hash.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

namespace {

using Clock = std::chrono::steady_clock;

/// "45 s", "2 min 5 s", "1 h 12 min".
std::string timeText(std::chrono::duration<double> time) {
  const auto seconds = std::int64_t(std::max(time.count(), 0.0) + 0.5);
  if (seconds < 60) return fmt::format("{} s", seconds);
  if (seconds < 3600) return fmt::format("{} min {} s", seconds / 60, seconds % 60);
  return fmt::format("{} h {} min", seconds / 3600, seconds / 60 % 60);
}

/// Whether nothing of the volume has extinction or emission, as far as is known.
template <typename AnyRenderer>
bool isTransparent(const AnyRenderer& renderer) {
  return renderer.occupiedVoxelCount() == 0u;
}

std::string whyNothingIsSeen(bool isTransparent) {
  if (isTransparent) return "all voxels are transparent; raise --density-scale, or change --transfer-function";
  return "the camera looks past the volume, or what it sees is transparent; leave out --camera-position and --look-at to frame it";
}

bool showsNothing(const Image& image) {
  return std::ranges::none_of(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.0f || pixel.r + pixel.g + pixel.b > 0.0f; });
}

/// Makes pixels black of which some number is NaN or infinite, which light beyond the range of single precision makes of them;
/// returns how many there were.
std::size_t clearPixelsThatAreNoNumbers(Image& image) {
  std::size_t cleared = 0;
  for (glm::vec4& pixel : image.pixels) {
    const float sum = pixel.r + pixel.g + pixel.b + pixel.a;
    if (std::isfinite(sum)) continue;
    pixel = glm::vec4(0.0f);
    ++cleared;
  }
  return cleared;
}

Progress prefixed(const Progress& progress, const std::string& prefix) {
  if (!progress) return {};
  return [progress, prefix](std::string_view stage, double fraction) {
    progress(fmt::format("{}{}", prefix, stage), fraction);
  };
}

}  // namespace

FrameSeries::FrameSeries(const RenderOptions& options, const Device& device, RunReport& report)
    : options_(options), device_(device), report_(report), line_(!options.messages.quiet && options.leads()) {}

void FrameSeries::draw(std::span<const Frame> frames) {
  frames_ = frames.size();
  begun_ = Clock::now();
  report_.device = device_.description();
  drawFilm(frames);
  addTimes(report_.stages, writer_.times());
  addTimes(report_.stages, device_.pipelines().times());
  report_.devicePeak = device_.peakBytes();
}

void FrameSeries::drawFilm(std::span<const Frame> frames) {
  const std::vector<std::string> inputs = volumesOf(frames);
  const MemoryLimits limits = memoryLimits(options_, device_);
  VolumesAhead volumes(inputs, [this, limits, turn = int(framesOfFirstVolume(frames)), count = inputs.size()](const std::string& input) {
    // Of a baked volume nothing finer is read than is needed, and nothing at all if it is drawn piece by piece.
    const SceneDescription scene = sceneOf(input);
    const int level = scene.finestLevelNeeded(turn);
    if (count == 1 && needsPieces(options_, limits, pieceDrawing(options_, scene, turn), level)) return std::shared_ptr<const Volume>();
    return std::make_shared<const Volume>(scene.readVolume(maximumVoxels(device_), level));
  });
  std::size_t failed = 0;
  for (const std::string& input : inputs) {
    const std::span<const Frame> own = frames.first(framesOfFirstVolume(frames));
    frames = frames.subspan(own.size());
    try {
      line_.begin(prefix() + "reading " + input);
      std::shared_ptr<const Volume> volume;
      {
        const StageTimer timer(report_.stages, "read volume");
        volume = volumes.next();
      }
      drawFitting(std::move(volume), own);
    } catch (const EmptyVolumeError& error) {
      if (inputs.size() == 1) throw;
      line_.erase();
      spdlog::warn("{}; it becomes an image of the background", withOptions(error));
      for (const Frame& frame : own) writeEmpty(frame);
    } catch (const Error& error) {
      if (inputs.size() == 1 || error.kind() != ErrorKind::Input) throw;
      line_.erase();
      spdlog::error("{}", withOptions(error));
      ++failed;
    }
  }
  finishWriting();
  if (failed == 0 && waiting_.empty()) return;
  if (failed == 0) fail(ErrorKind::Input, "no frame of {} holds anything to draw", frames_);
  fail(ErrorKind::Input, "{} of {} volumes could not be drawn, for the reasons above", failed, inputs.size());
}

/// A baked volume that the device cannot hold is drawn piece by piece where that is possible, else from a coarser level. `volume` is
/// null where it is known beforehand that pieces are drawn.
void FrameSeries::drawFitting(std::shared_ptr<const Volume> volume, std::span<const Frame> frames) {
  const SceneDescription scene = sceneOf(frames.front().input);
  // The frames of one volume alone: of a film's volumes, two are in memory anyway.
  PieceDrawing pieces{.file = scene.input.baked()};
  if (pieces.file && frames.size() == frames_) pieces = pieceDrawing(options_, scene, int(frames.size()));
  const std::shared_ptr<const fvx::FvxFile> file = pieces.file;
  const RunReport before = report_;
  const std::size_t drawn = drawn_;
  const std::optional<Scene> reference = reference_;
  bool inPieces = !volume, triedPieces = inPieces || pieces.way == PieceDrawing::Way::None;
  for (int level = scene.finestLevelNeeded(int(frames.size()));;) {
    try {
      return inPieces ? drawPieces(pieces, level, frames) : drawVolume(std::move(volume), pieces, frames);
    } catch (const Error& error) {
      // Processes that draw shares cannot change the level each by itself.
      if (error.kind() != ErrorKind::OutOfMemory || options_.drawsShares()) throw;
      inPieces = !std::exchange(triedPieces, true);
      if (inPieces) {
        spdlog::debug("{}; drawing it piece by piece", withOptions(error));
      } else {
        if (file) level = std::max(level, finestLevel(*file, maximumVoxels(device_)));  // which is the one that was opened
        if (++level >= (file ? file->levels() : 1)) throw;
        const std::string why = pieces.whyNone.empty() ? "" : fmt::format(", and it cannot be drawn piece by piece: {}", pieces.whyNone);
        spdlog::warn("{}{}; drawing it at 1/{} of its resolution", withOptions(error), why, 1 << level);
        pieces.way = PieceDrawing::Way::None;  // the coarser level need not be exact
      }
    }
    report_ = before;
    drawn_ = drawn;
    reference_ = reference;
    volume = inPieces ? nullptr : std::make_shared<const Volume>(scene.readVolume(maximumVoxels(device_), level));
  }
}

SceneDescription FrameSeries::sceneOf(const std::string& input) const {
  SceneDescription scene = options_.scene.description;
  scene.input.volume = input;
  return scene;
}

Scene FrameSeries::resolve(std::shared_ptr<const Volume> volume, const std::string& input) const {
  const SceneDescription scene = sceneOf(input);
  if (options_.fixedView && reference_) return scene.resolveLike(*reference_, std::move(volume));
  return scene.resolve(std::move(volume));
}

OptionList FrameSeries::describe(const Scene& view, const std::string& input) const {
  return options_.scene.ownOptions(sceneOf(input).resolved(view));
}

/// What an .exr says of its making besides the options.
std::map<std::string, std::string> FrameSeries::facts() const {
  std::map<std::string, std::string> facts{{"device", report_.device.name}, {"driver", report_.device.driver}};
  if (options_.drawsShares()) {
    facts["share"] = sharePartText(options_.shares.whole());
    facts["content"] = report_.contentHash;
    if (options_.shares.coloredParts) facts["color-parts"] = std::to_string(*options_.shares.coloredParts);
  }
  return facts;
}

/// Fails where the processes of the group would not draw parts of one image.
void FrameSeries::agree(const Scene& view, const fvx::FvxFile* file) {
  if (options_.drawsShares()) {
    const bool hasEnvironment = view.lighting && view.lighting->environment;
    report_.contentHash =
        contentHash(*view.volume, view.classification, hasEnvironment ? view.lighting->environment.get() : nullptr);
    // Of regions the volume's values are not read: the header's checksum stands for those of all sections.
    if (file != nullptr) report_.contentHash += fmt::format("-{:016x}", file->header().hash);
  }
  if (options_.group == nullptr) return;
  options_.group->agree("another version of the program", programVersion());
  options_.group->agree("another volume, transfer function or environment", report_.contentHash);
  OptionList options;
  for (const auto& [name, value] : report_.options)
    if (!name.empty()) options.emplace_back(name, value);  // the volume's own name may differ from machine to machine
  options_.group->agree("other options", commandText(options));
}

/// What is said about the first volume.
void FrameSeries::begin(const Scene& view, std::size_t frames) {
  const SceneDescription& scene = options_.scene.description;
  report_.scene = frames > 1 ? scene.resolvedTurn(view, int(frames)) : scene.resolved(view);
  report_.options = options_.scene.ownOptions(report_.scene);
  line_.erase();
  logRemarks(scene, view);
  logOptions(report_.options);
  mentionCpu(device_);
}

/// Resolves what a volume's frames have in common. The regions of `file` are drawn where it is not null.
std::vector<Camera> FrameSeries::beginVolume(Scene& view, std::span<const Frame> frames, const fvx::FvxFile* file) {
  const bool isFirst = !reference_;
  std::vector<Camera> cameras{view.camera};
  if (frames.size() > 1) cameras = sceneOf(frames.front().input).cameras(*view.volume, view.classification, int(frames.size()));
  view.camera = cameras.front();
  line_.erase();
  if (isFirst)
    begin(view, frames.size());
  else
    logWarnings(*view.volume, !view.classification.transferFunction);
  agree(view, file);
  if (isFirst || !options_.fixedView) reference_ = view;
  return cameras;
}

/// Where the frames could be drawn cube by cube, nothing is drawn otherwise for lack of memory: the image does not depend on it.
void FrameSeries::drawVolume(std::shared_ptr<const Volume> volume, const PieceDrawing& pieces, std::span<const Frame> frames) {
  Scene view = resolve(std::move(volume), frames.front().input);
  const std::vector<Camera> cameras = beginVolume(view, frames);
  const TableSettings table = options_.scene.description.method.table();
  FrameSettings settings = options_.frameSettings();
  settings.lighting = view.lighting;
  if (pieces.way == PieceDrawing::Way::Cubes) {
    settings.draw = Draw::Gather;
    if (settings.lighting) settings.lighting->attenuation = lightAttenuationFor(settings);
  }
  try {
    Renderer renderer(device_, *view.volume, view.classification, table, prefixed(line_.progress(), prefix()));
    const std::vector<StageTime> built = renderer.timings();
    addTimes(report_.stages, built);
    drawFrames(renderer, settings, view, cameras, frames, built.size());
  } catch (const Error& error) {
    throw withWholeNeed(error, device_, *view.volume, view.classification, table.directions, settings);
  }
}

void FrameSeries::drawPieces(const PieceDrawing& pieces, int level, std::span<const Frame> frames) {
  const bool cubes = pieces.way == PieceDrawing::Way::Cubes;
  Scene view = resolve(std::make_shared<const Volume>(bakedOutline(*pieces.file, cubes ? level : 0)), frames.front().input);
  const std::vector<Camera> cameras = beginVolume(view, frames, pieces.file.get());
  FrameSettings settings = options_.frameSettings();
  settings.lighting = view.lighting;
  if (cubes) {
    spdlog::debug("drawn by gathering, cube by cube: the volume does not fit into memory at once");
    StreamedRenderer renderer(device_, pieces.file, level, view.classification, options_.scene.description.method.table());
    drawFrames(renderer, std::move(settings), std::move(view), cameras, frames, 0);
    for (std::size_t above = 0; above < renderer.cubesRead().size(); ++above)
      if (renderer.cubesRead()[above] > 0)
        spdlog::debug("{} cubes of {}³ blocks of {}³ voxels drawn for the last frame", renderer.cubesRead()[above],
                      StreamedRenderer::kCubeEdge, 1 << (std::size_t(level) + above));
    return;
  }
  if (options_.drawsShares())
    spdlog::debug("drawn by splats, region by region: only the regions of the own shares are read");
  else
    spdlog::debug("drawn by splats, region by region: the volume does not fit into memory at once, and gathering is not possible so: {}",
                  pieces.whyNotCubes);
  RegionRenderer renderer(device_, pieces.file, view.classification, options_.scene.description.method.table(), frames.size() > 1);
  drawFrames(renderer, std::move(settings), std::move(view), cameras, frames, 0);
  const RegionRenderer::Counts counts = renderer.counts();
  for (std::size_t i = 0; i < counts.drawn.size(); ++i)
    if (counts.drawn[i] > 0)
      spdlog::debug("{} regions of {}³ blocks of {}³ voxels drawn for the last frame", counts.drawn[i], fvx::kRegionEdge, 1 << i);
}

template <typename AnyRenderer>
void FrameSeries::drawFrames(AnyRenderer& renderer, FrameSettings settings, Scene view, const std::vector<Camera>& cameras,
                             std::span<const Frame> frames, std::size_t stagesBefore) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (options_.group != nullptr && !options_.group->draws(drawn_)) {
      drawnElsewhere_.push_back(&frames[i]);
      ++drawn_;
      continue;
    }
    view.camera = cameras[i];
    drawFrame(renderer, view, settings, frames[i]);
    ++drawn_;
    const std::vector<StageTime> times = renderer.timings();
    addTimes(report_.stages, std::span(times).subspan(stagesBefore));
  }
  finishAddingUp();
  addToReport(renderer, *view.volume);
  for (const Frame* empty : std::exchange(waiting_, {})) writeEmpty(*empty);
}

/// The sums of this process's shares.
template <typename AnyRenderer>
FixedSums FrameSeries::drawSums(AnyRenderer& renderer, const Camera& camera, const FrameSettings& settings) {
  const Progress progress = prefixed(line_.progress(), prefix());
  if constexpr (std::is_same_v<AnyRenderer, Renderer>) {
    if (options_.shares.coloredParts) return drawColoredParts(renderer, camera, settings, *options_.shares.coloredParts, progress);
  }
  const SharePart part = options_.group != nullptr ? options_.group->part() : options_.shares.whole();
  return renderer.renderShares(camera, settings, part, progress);
}

template <typename AnyRenderer>
void FrameSeries::drawFrame(AnyRenderer& renderer, const Scene& view, const FrameSettings& settings, const Frame& frame) {
  if (!options_.drawsShares())
    return complete(renderer.render(view.camera, settings, prefixed(line_.progress(), prefix())), isTransparent(renderer), view, frame);
  if constexpr (!std::is_same_v<AnyRenderer, StreamedRenderer>) drawShares(renderer, view, settings, frame);
}

/// Draws this process's shares, and hands on or writes their sums or the image of them.
template <typename AnyRenderer>
void FrameSeries::drawShares(AnyRenderer& renderer, const Scene& view, const FrameSettings& settings, const Frame& frame) {
  FixedSums sums = drawSums(renderer, view.camera, settings);
  if (options_.group != nullptr) {
    finishAddingUp();
    addingUp_ = {&frame, view, isTransparent(renderer), std::async([group = options_.group, sums = std::move(sums)]() mutable {
                   AddedUp result;
                   const StageTimer timer(result.times, "add up sums");
                   if (group->addUp(sums)) result.sums = std::move(sums);
                   return result;
                 })};
  } else if (options_.shares.sums) {
    const DeferredInterrupts wholeFile;
    const StageTimer timer(report_.stages, "write images");
    writeSums(frame.files.front(), sums, imageHeader(options_.scene.description, view, "render", describe(view, frame.input), facts()));
    printNames(frame);
  } else {
    complete(resolveSums(sums, settings.composite == Composite::Normalised), isTransparent(renderer), view, frame);
  }
}

/// Waits for the sums of the group's last frame, and writes its image where they are.
void FrameSeries::finishAddingUp() {
  if (!addingUp_.result.valid()) return;
  const AddedUp added = addingUp_.result.get();
  addTimes(report_.stages, added.times);
  if (!added.sums) return;
  const bool normalised = options_.frameSettings().composite == Composite::Normalised;
  complete(resolveSums(*added.sums, normalised), addingUp_.isTransparent, addingUp_.view, *addingUp_.frame);
}

void FrameSeries::complete(Image image, bool isTransparent, const Scene& view, const Frame& frame) {
  const std::string name = frames_ == 1 ? "" : frame.files.front() + ": ";
  line_.erase();
  if (const std::size_t pixels = clearPixelsThatAreNoNumbers(image); pixels > 0)
    spdlog::warn("{}{} pixels are beyond the range of numbers and become black: use less extreme lights, emission and distances", name,
                 pixels);
  if (showsNothing(image)) spdlog::warn("{}nothing is seen: {}", name, whyNothingIsSeen(isTransparent));
  write(std::move(image), view, frame);
}

/// Writes while the next frame is drawn.
void FrameSeries::write(Image image, const Scene& view, const Frame& frame) {
  line_.begin(prefix() + "writing " + frame.files.front());
  finishWriting();
  // What a file says of its making is how `render` repeats this frame alone.
  writer_.start([&scene = options_.scene.description, files = frame.files, image = std::move(image), view,
                 options = describe(view, frame.input),
                 facts = facts()] { writeImages(image, scene, files, view, "render", options, facts); });
  written_ = &frame;
}

/// Waits until the frame before is written, and prints the names of its files.
void FrameSeries::finishWriting() {
  writer_.finish();
  if (const Frame* const written = std::exchange(written_, nullptr)) printNames(*written);
}

void FrameSeries::printNames(const Frame& frame) {
  line_.erase();
  if (options_.messages.quiet || !options_.leads()) return;
  for (const std::string& file : frame.files) fmt::print("{}\n", file);
  std::fflush(stdout);
}

void FrameSeries::printDrawnElsewhere() {
  for (const Frame* frame : drawnElsewhere_) printNames(*frame);
}

void FrameSeries::writeEmpty(const Frame& frame) {
  if (!reference_) {
    waiting_.push_back(&frame);
    return;
  }
  ++drawn_;
  if (!options_.leads()) return;
  const FrameSettings settings = options_.frameSettings();
  const std::size_t pixels = std::size_t(settings.size.x) * std::size_t(settings.size.y);
  Image image{.size = settings.size, .pixels = std::vector<glm::vec4>(pixels, glm::vec4(0.0f))};
  if (settings.depth) image.depth.assign(pixels, std::numeric_limits<float>::infinity());
  Scene view = *reference_;
  Volume nothing;
  nothing.source = std::filesystem::path(frame.input).filename().string();
  view.volume = std::make_shared<const Volume>(std::move(nothing));
  view.classification.emission.reset();
  write(std::move(image), view, frame);
}

/// Of the last volume.
template <typename AnyRenderer>
void FrameSeries::addToReport(const AnyRenderer& renderer, const Volume& volume) {
  report_.lackedRoomForRays |= renderer.lackedRoomForRays();
  report_.lackedRoomForGather |= renderer.lackedRoomForGather();
  report_.visibleVoxels = renderer.occupiedVoxelCount();
  report_.voxels = volume.voxelCount();
  report_.memory = renderer.memory();
  report_.cut = renderer.cutCounts();
}

/// "frame 3 of 72, 2 min 5 s left: ", which starts what is said while one of several frames is made.
std::string FrameSeries::prefix() const {
  if (frames_ == 1) return "";
  std::string left;
  if (drawn_ > 0) left = fmt::format(", {} left", timeText((Clock::now() - begun_) / double(drawn_) * double(frames_ - drawn_)));
  return fmt::format("frame {} of {}{}: ", drawn_ + 1, frames_, left);
}

}  // namespace freevoxels
