#include "apps/freevoxels/frame_series.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "apps/freevoxels/colored_parts.h"
#include "apps/freevoxels/failure.h"
#include "apps/freevoxels/film_view.h"
#include "apps/freevoxels/share_group.h"
#include "engine/memory_planner.h"
#include "engine/region_renderer.h"
#include "engine/renderer.h"
#include "engine/storage/baked_volume.h"
#include "engine/streamed_renderer.h"
#include "engine/volume/content_hash.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

namespace {

/// Whether nothing of the volume has extinction or emission, as far as is known.
bool isTransparent(const FrameRenderer& renderer) {
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

/// Says which pieces of a baked volume the last frame drew: `counts` by level, beginning with `finest`.
void logPieces(std::string_view pieces, const std::vector<std::size_t>& counts, int edge, int finest) {
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0)
      spdlog::debug("{} {} of {}³ blocks of {}³ voxels drawn for the last frame", counts[i], pieces, edge, 1 << (std::size_t(finest) + i));
}

}  // namespace

FrameSeries::FrameSeries(const RenderOptions& options, const Device& device, RunReport& report)
    : options_(options),
      device_(device),
      report_(report),
      progress_(!options.messages.quiet && options.leads()),
      writer_(options, report, progress_) {}

void FrameSeries::draw(std::span<const FrameJob> jobs) {
  progress_.start(jobs.size());
  report_.device = device_.description();
  drawVolumes(jobs);
  addTimes(report_.stages, writer_.times());
  addTimes(report_.stages, device_.pipelines().times());
  report_.devicePeak = device_.peakBytes();
}

void FrameSeries::printDrawnElsewhere() {
  for (const FrameJob* job : drawnElsewhere_) writer_.printNames(*job);
}

/// Whether all frames of the volume are skipped, and it does not decide how others are seen.
bool FrameSeries::needsNoVolume(std::span<const FrameJob> jobs) const {
  return std::ranges::all_of(jobs, &FrameJob::isSkipped) && (hasReference_ || !options_.fixedView);
}

void FrameSeries::drawVolumes(std::span<const FrameJob> jobs) {
  const std::vector<std::string> inputs = volumesOf(jobs);
  isFilm_ = inputs.size() > 1;
  const MemoryLimits limits = memoryLimits(options_, device_);
  if (isFilm_ && !options_.fixedView) surveyFilm(inputs);
  const bool isSurveyed = reference_.has_value();
  const int turn = int(framesOfFirstVolume(jobs));
  VolumesAhead volumes(inputs, [this, limits, isSurveyed, turn, jobs](const std::string& input) {
    const auto first = std::ranges::find(jobs, input, &FrameJob::input);
    const std::span<const FrameJob> own = jobs.subspan(std::size_t(first - jobs.begin()));
    if (needsNoVolume(own.first(framesOfFirstVolume(own)))) return std::shared_ptr<const Volume>();
    // A baked volume is read no finer than the frames need, and not at all if they are drawn piece by piece.
    const SceneDescription scene = options_.scene.description.of(input);
    const int level = scene.finestLevelNeeded(scene.input.baked().get(), turn);
    if (!isFilm_ && needsPieces(options_, limits, pieceDrawing(options_, scene, turn), level)) return std::shared_ptr<const Volume>();
    return std::make_shared<const Volume>(scene.readVolume(maximumVoxels(device_), level, {}, isSurveyed));
  });
  std::size_t failed = 0;
  while (!jobs.empty()) {
    const std::span<const FrameJob> own = jobs.first(framesOfFirstVolume(jobs));
    jobs = jobs.subspan(own.size());
    if (!drawNext(volumes, own)) ++failed;
  }
  writer_.finish();
  if (failed > 0) fail(ErrorKind::Input, "{} of {} volumes could not be drawn, for the reasons above", failed, inputs.size());
  if (!waiting_.empty()) fail(ErrorKind::Input, "no frame of {} holds anything to draw", progress_.frames());
}

/// Chooses the view of all frames.
void FrameSeries::surveyFilm(std::span<const std::string> inputs) {
  progress_.begin("looking through the film");
  const StageTimer timer(report_.stages, "survey film");
  std::optional<FilmView> view = viewOfFilm(options_.scene.description, inputs, maximumVoxels(device_));
  progress_.erase();
  if (!view) return;
  reference_ = std::move(view->scene);
  hasReference_ = true;
  announce(*reference_, 1);
  const auto nameOf = [](const std::string& input) { return std::filesystem::path(input).filename().string(); };
  spdlog::info(
      "camera and scales are those of the whole film, in which {} holds most{}; change it with --fixed-view, for those of the "
      "first frame, or --no-fixed-view, for each frame's own",
      nameOf(view->largest), view->brightest.empty() ? "" : fmt::format(" and {} shines most", nameOf(view->brightest)));
}

/// Draws the frames of the next volume. False, after a message, for a volume of a film that is no volume.
bool FrameSeries::drawNext(VolumesAhead& volumes, std::span<const FrameJob> jobs) {
  try {
    progress_.begin("reading " + jobs.front().input);
    std::shared_ptr<const Volume> volume;
    {
      const StageTimer timer(report_.stages, "read volume");
      volume = volumes.next();
    }
    if (needsNoVolume(jobs)) {
      progress_.drawn += jobs.size();
      return true;
    }
    drawFitting(std::move(volume), jobs);
    return true;
  } catch (const EmptyVolumeError& error) {
    if (!isFilm_) throw;
    progress_.erase();
    spdlog::warn("{}; it becomes an image of the background", withOptions(error));
    for (const FrameJob& job : jobs) writeEmpty(job);
    return true;
  } catch (const Error& error) {
    if (!isFilm_ || error.kind() != ErrorKind::Input) throw;
    progress_.erase();
    spdlog::error("{}", withOptions(error));
    return false;
  }
}

/// A baked volume that the device cannot hold is drawn piece by piece where that is possible, else from a coarser level. `volume` is
/// null where it is known beforehand that pieces are drawn.
void FrameSeries::drawFitting(std::shared_ptr<const Volume> volume, std::span<const FrameJob> jobs) {
  const SceneDescription scene = options_.scene.description.of(jobs.front().input);
  // A film keeps two volumes in memory anyway.
  PieceDrawing pieces{.file = scene.input.baked()};
  if (pieces.file && !isFilm_) pieces = pieceDrawing(options_, scene, int(jobs.size()));
  const RunReport reportBefore = report_;
  const std::size_t drawnBefore = progress_.drawn;
  const std::optional<Scene> referenceBefore = reference_;
  bool inPieces = !volume;
  for (int level = scene.finestLevelNeeded(pieces.file.get(), int(jobs.size()));;) {
    try {
      return inPieces ? drawPieces(pieces, level, jobs) : drawWhole(std::move(volume), pieces, jobs);
    } catch (const Error& error) {
      // Processes that draw shares cannot change the level each by itself.
      if (error.kind() != ErrorKind::OutOfMemory || options_.drawsShares()) throw;
      inPieces = !inPieces && pieces.way != PieceDrawing::Way::None;
      if (inPieces) {
        spdlog::debug("{}; drawing it piece by piece", withOptions(error));
      } else {
        if (pieces.file) level = std::max(level, finestLevel(*pieces.file, maximumVoxels(device_)));  // which is the one that was opened
        if (++level >= (pieces.file ? pieces.file->levels() : 1)) throw;
        const std::string why = pieces.whyNone.empty() ? "" : fmt::format(", and it cannot be drawn piece by piece: {}", pieces.whyNone);
        spdlog::warn("{}{}; drawing it at 1/{} of its resolution", withOptions(error), why, 1 << level);
        pieces.way = PieceDrawing::Way::None;  // the coarser level need not be exact
      }
    }
    report_ = reportBefore;
    progress_.drawn = drawnBefore;
    reference_ = referenceBefore;
    volume = inPieces ? nullptr : std::make_shared<const Volume>(scene.readVolume(maximumVoxels(device_), level));
  }
}

/// Where the frames could be drawn cube by cube, nothing is drawn otherwise for lack of memory: the image does not depend on it.
void FrameSeries::drawWhole(std::shared_ptr<const Volume> volume, const PieceDrawing& pieces, std::span<const FrameJob> jobs) {
  VolumeView view = beginVolume(std::move(volume), jobs);
  FrameSettings& settings = view.settings;
  if (pieces.way == PieceDrawing::Way::Cubes) {
    settings.draw = Draw::Gather;
    if (settings.lighting) settings.lighting->attenuation = lightAttenuationFor(settings);
  }
  const TableSettings table = options_.scene.description.method.table();
  try {
    Renderer renderer(device_, *view.scene.volume, view.scene.classification, table, progress_.progress());
    drawFrames(renderer, view, jobs);
  } catch (const Error& error) {
    throw withWholeNeed(error, device_, *view.scene.volume, view.scene.classification, table.directions, settings);
  }
}

void FrameSeries::drawPieces(const PieceDrawing& pieces, int level, std::span<const FrameJob> jobs) {
  const bool cubes = pieces.way == PieceDrawing::Way::Cubes;
  const auto outline = std::make_shared<const Volume>(bakedOutline(*pieces.file, cubes ? level : 0));
  const VolumeView view = beginVolume(outline, jobs, pieces.file.get());
  const TableSettings table = options_.scene.description.method.table();
  if (cubes) {
    spdlog::debug("drawn by gathering, cube by cube: the volume does not fit into memory at once");
    StreamedRenderer renderer(device_, pieces.file, level, view.scene.classification, table);
    drawFrames(renderer, view, jobs);
    return logPieces("cubes", renderer.cubesRead(), StreamedRenderer::kCubeEdge, level);
  }
  if (options_.drawsShares())
    spdlog::debug("drawn by splats, region by region: only the regions of the own shares are read");
  else
    spdlog::debug("drawn by splats, region by region: the volume does not fit into memory at once, and gathering is not possible so: {}",
                  pieces.whyNotCubes);
  RegionRenderer renderer(device_, pieces.file, view.scene.classification, table, jobs.size() > 1);
  drawFrames(renderer, view, jobs);
  logPieces("regions", renderer.counts().drawn, fvx::kRegionEdge, 0);
}

/// Resolves what a volume's frames have in common. The regions or cubes of `file` are drawn where it is not null.
FrameSeries::VolumeView FrameSeries::beginVolume(std::shared_ptr<const Volume> volume, std::span<const FrameJob> jobs,
                                                 const fvx::FvxFile* file) {
  const SceneDescription description = options_.scene.description.of(jobs.front().input);
  const bool isFirst = !reference_, isFixed = options_.fixedView.value_or(isFilm_);
  VolumeView view{
      .scene = isFixed && !isFirst ? description.resolveLike(*reference_, std::move(volume)) : description.resolve(std::move(volume)),
      .settings = options_.frameSettings()};
  Scene& scene = view.scene;
  view.cameras = {scene.camera};
  if (jobs.size() > 1) view.cameras = description.cameras(*scene.volume, scene.classification, int(jobs.size()));
  scene.camera = view.cameras.front();
  view.settings.lighting = scene.lighting;
  progress_.erase();
  if (isFirst)
    announce(scene, jobs.size());
  else
    logWarnings(*scene.volume, !scene.classification.transferFunction);
  agree(scene, file);
  if (isFirst || !isFixed) reference_ = scene;
  hasReference_ = true;
  return view;
}

/// Reports and says how the first volume is drawn.
void FrameSeries::announce(const Scene& view, std::size_t frames) {
  const SceneDescription& scene = options_.scene.description;
  report_.scene = frames > 1 ? scene.resolvedTurn(view, int(frames)) : scene.resolved(view);
  report_.options = options_.scene.ownOptions(report_.scene);
  logRemarks(scene, view);
  logOptions(report_.options);
  mentionCpu(device_);
}

/// Fails where the processes of the group would not draw parts of one image.
void FrameSeries::agree(const Scene& view, const fvx::FvxFile* file) {
  if (options_.drawsShares()) {
    const bool hasEnvironment = view.lighting && view.lighting->environment;
    report_.contentHash =
        contentHash(*view.volume, view.classification, hasEnvironment ? view.lighting->environment.get() : nullptr);
    // The values of regions are not read: the header's checksum stands for those of all sections.
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

void FrameSeries::drawFrames(FrameRenderer& renderer, const VolumeView& view, std::span<const FrameJob> jobs) {
  const std::vector<StageTime> built = renderer.timings();
  addTimes(report_.stages, built);
  Scene scene = view.scene;
  for (std::size_t i = 0; i < jobs.size(); ++i, ++progress_.drawn) {
    if (jobs[i].isSkipped) continue;
    if (options_.group != nullptr && !options_.group->draws(progress_.drawn)) {
      drawnElsewhere_.push_back(&jobs[i]);
      continue;
    }
    scene.camera = view.cameras[i];
    if (options_.drawsShares())  // which only a ShareRenderer is chosen for
      drawShares(dynamic_cast<ShareRenderer&>(renderer), scene, view.settings, jobs[i]);
    else
      complete(renderer.render(scene.camera, view.settings, progress_.progress()), isTransparent(renderer), scene, jobs[i]);
    const std::vector<StageTime> times = renderer.timings();
    addTimes(report_.stages, std::span(times).subspan(built.size()));
  }
  finishAddingUp();
  report(renderer, *scene.volume);
  for (const FrameJob* empty : std::exchange(waiting_, {})) writeEmpty(*empty);
}

/// Draws this process's shares, and hands on or writes their sums or the image of them.
void FrameSeries::drawShares(ShareRenderer& renderer, const Scene& view, const FrameSettings& settings, const FrameJob& job) {
  const SharePart part = options_.group != nullptr ? options_.group->part() : options_.shares.whole();
  const std::optional<int> coloredParts = options_.shares.coloredParts;
  FixedSums sums = coloredParts ? drawColoredParts(renderer, view.camera, settings, *coloredParts, progress_.progress())
                                : renderer.renderShares(view.camera, settings, part, progress_.progress());
  if (options_.group != nullptr) {
    finishAddingUp();
    addingUp_ = {&job, view, isTransparent(renderer), std::async([group = options_.group, sums = std::move(sums)]() mutable {
                   AddedUp result;
                   const StageTimer timer(result.times, "add up sums");
                   if (group->addUp(sums)) result.sums = std::move(sums);
                   return result;
                 })};
  } else if (options_.shares.sums) {
    const StageTimer timer(report_.stages, "write images");
    writer_.writeSums(sums, view, job);
  } else {
    complete(resolveSums(sums, settings.composite == Composite::Normalised), isTransparent(renderer), view, job);
  }
}

/// Waits for the sums of the group's last frame, and writes its image where they are.
void FrameSeries::finishAddingUp() {
  if (!addingUp_.result.valid()) return;
  const AddedUp added = addingUp_.result.get();
  addTimes(report_.stages, added.times);
  if (!added.sums) return;
  const bool normalised = options_.frameSettings().composite == Composite::Normalised;
  complete(resolveSums(*added.sums, normalised), addingUp_.isTransparent, addingUp_.view, *addingUp_.job);
}

void FrameSeries::complete(Image image, bool isTransparent, const Scene& view, const FrameJob& job) {
  const std::string name = progress_.frames() == 1 ? "" : job.files.front() + ": ";
  progress_.erase();
  if (const std::size_t pixels = clearPixelsThatAreNoNumbers(image); pixels > 0)
    spdlog::warn("{}{} pixels are beyond the range of numbers and become black: use less extreme lights, emission and distances", name,
                 pixels);
  if (showsNothing(image)) spdlog::warn("{}nothing is seen: {}", name, whyNothingIsSeen(isTransparent));
  writer_.write(std::move(image), view, job);
}

void FrameSeries::writeEmpty(const FrameJob& job) {
  if (!reference_) {
    waiting_.push_back(&job);
    return;
  }
  ++progress_.drawn;
  if (!options_.leads() || job.isSkipped) return;
  const FrameSettings settings = options_.frameSettings();
  const std::size_t pixels = std::size_t(settings.size.x) * std::size_t(settings.size.y);
  Image image{.size = settings.size, .pixels = std::vector<glm::vec4>(pixels, glm::vec4(0.0f))};
  if (settings.depth) image.depth.assign(pixels, std::numeric_limits<float>::infinity());
  Scene view = *reference_;
  Volume nothing;
  nothing.source = std::filesystem::path(job.input).filename().string();
  view.volume = std::make_shared<const Volume>(std::move(nothing));
  view.classification.emission.reset();
  writer_.write(std::move(image), view, job);
}

/// The report describes the last volume.
void FrameSeries::report(const FrameRenderer& renderer, const Volume& volume) {
  report_.lackedRoomForRays |= renderer.lackedRoomForRays();
  report_.lackedRoomForGather |= renderer.lackedRoomForGather();
  report_.visibleVoxels = renderer.occupiedVoxelCount();
  report_.voxels = volume.voxelCount();
  report_.memory = renderer.memory();
  report_.cut = renderer.cutCounts();
}

}  // namespace freevoxels
