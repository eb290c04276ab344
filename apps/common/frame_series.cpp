#include "apps/common/frame_series.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/common/colored_parts.h"
#include "apps/common/failure.h"
#include "apps/common/film_scenes.h"
#include "apps/common/frame_layers.h"
#include "apps/common/output_options.h"
#include "apps/common/share_group.h"
#include "engine/cube_level.h"
#include "engine/description/flight_description.h"
#include "engine/volume/content_hash.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

namespace {

/// Whether nothing of the volume has extinction or emission, as far as is known.
bool isTransparent(const Renderer& renderer) {
  return renderer.occupiedVoxelCount() == 0u;
}

std::string whyNothingIsSeen(bool isTransparent, bool isSlice) {
  if (isSlice) return "the plane meets no voxel with data; choose another --slice";
  if (isTransparent) return "all voxels are transparent; raise --density-scale, or change --transfer-function";
  return "the camera looks past the volume, or what it sees is transparent or behind --holdout; leave out --camera-position and --look-at "
         "to frame it";
}

bool showsNothing(const Image& image) {
  return std::ranges::none_of(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.0f || pixel.r + pixel.g + pixel.b > 0.0f; });
}

/// Says which cubes of a volume the last frame drew, if it did.
void logCubes(const Renderer& renderer) {
  if (!renderer.drewInCubes()) return;
  spdlog::debug("drawn by gathering, cube by cube: the volume does not fit into memory at once");
  const std::vector<std::size_t> counts = renderer.cubesRead();
  for (std::size_t level = 0; level < counts.size(); ++level)
    if (counts[level] > 0)
      spdlog::debug("{} cubes of up to {}³ blocks drawn for the last frame, each block 2^{} voxels of what was opened along an edge",
                    counts[level], PieceTree::kLongestEdge, level);
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
  try {
    drawVolumes(jobs);
  } catch (...) {
    writer_.finishAfterFailure();
    throw;
  }
  addTimes(report_.stages, writer_.times());
  addTimes(report_.stages, device_.pipelines().times());
  report_.devicePeak = device_.peakBytes();
}

void FrameSeries::printDrawnElsewhere() {
  for (const FrameJob* job : drawnElsewhere_) writer_.printNames(*job);
}

/// Whether all frames of the volume are skipped, and it does not decide how others are seen.
bool FrameSeries::needsNoVolume(std::span<const FrameJob> jobs) const {
  return std::ranges::all_of(jobs, &FrameJob::isSkipped) && (film_->hasReference() || !options_.fixedView);
}

void FrameSeries::drawVolumes(std::span<const FrameJob> jobs) {
  SceneDescription description = options_.scene.description;
  description.input.memoryBytes = options_.device.memoryBytes();
  film_.emplace(std::move(description), volumesOf(jobs), options_.fixedView);
  surveyFilm();
  const int turn = int(framesOfFirstVolume(jobs));
  VolumesAhead volumes(film_->inputs(), [this, turn, jobs](const std::string& input) {
    const auto first = std::ranges::find(jobs, input, &FrameJob::input);
    const std::span<const FrameJob> own = jobs.subspan(std::size_t(first - jobs.begin()));
    if (needsNoVolume(own.first(framesOfFirstVolume(own)))) return std::shared_ptr<const VolumeSource>();
    return film_->read(input, turn);
  });
  std::size_t failed = 0;
  while (!jobs.empty()) {
    const std::span<const FrameJob> own = jobs.first(framesOfFirstVolume(jobs));
    jobs = jobs.subspan(own.size());
    if (!drawNext(volumes, own)) ++failed;
  }
  writer_.finish();
  if (failed > 0) fail(ErrorKind::Input, "{} of {} volumes could not be drawn, for the reasons above", failed, film_->inputs().size());
  if (!emptyFramesToWrite_.empty()) fail(ErrorKind::Input, "no frame of {} holds anything to draw", progress_.frames());
}

/// Chooses the view of all frames, where the film decides it.
void FrameSeries::surveyFilm() {
  if (!film_->isSeenAsAWhole()) return;
  progress_.begin("looking through the film");
  const StageTimer timer(report_.stages, "survey film");
  const std::optional<FilmView> view = film_->survey();
  progress_.erase();
  if (!view) return;
  announce(view->scene, 1);
  spdlog::info("{}; change it with --fixed-view, for those of the first frame, or --no-fixed-view, for each frame's own", remarkOf(*view));
}

/// Draws the frames of the next volume. False, after a message, for a volume of a film that is no volume.
bool FrameSeries::drawNext(VolumesAhead& volumes, std::span<const FrameJob> jobs) {
  try {
    progress_.begin("reading " + jobs.front().input);
    std::shared_ptr<const VolumeSource> source;
    {
      const StageTimer timer(report_.stages, "read volume");
      source = volumes.next();
    }
    if (needsNoVolume(jobs)) {
      progress_.drawn += jobs.size();
      return true;
    }
    const VolumeView view = beginVolume(source, jobs);
    if (options_.scene.description.method.slice) {
      drawSliceOf(*source, view, jobs);
      return true;
    }
    Renderer renderer(device_, view.scene.volumes(source), options_.scene.description.method.table(), progress_.progress());
    drawFrames(renderer, view, jobs);
    return true;
  } catch (const EmptyVolumeError& error) {
    if (!film_->isFilm()) throw;
    progress_.erase();
    spdlog::warn("{}; it becomes an image of the background", withOptions(error));
    for (const FrameJob& job : jobs) writeEmpty(job);
    return true;
  } catch (const Error& error) {
    if (!film_->isFilm() || error.kind() != ErrorKind::Input) throw;
    progress_.erase();
    spdlog::error("{}", withOptions(error));
    return false;
  }
}

/// Resolves what a volume's frames have in common.
FrameSeries::VolumeView FrameSeries::beginVolume(const std::shared_ptr<const VolumeSource>& source, std::span<const FrameJob> jobs) {
  std::shared_ptr<const Volume> volume = known(source);
  const std::string& input = jobs.front().input;
  const bool isFirst = !film_->reference();
  VolumeView view{.scene = film_->resolve(input, std::move(volume)), .settings = options_.frameSettings()};
  Scene& scene = view.scene;
  view.frames = {{.camera = scene.camera, .lights = {}}};
  if (jobs.size() > 1) view.frames = options_.scene.description.of(input).views(scene, int(jobs.size()));
  scene.show(view.frames.front());
  view.settings.lighting = scene.lighting;
  progress_.erase();
  if (isFirst)
    announce(scene, jobs.size());
  else
    logWarnings(*scene.volume, !scene.classification.transferFunction);
  agree(scene, *source, jobs.front());
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
void FrameSeries::agree(const Scene& view, const VolumeSource& source, const FrameJob& job) {
  if (options_.drawsShares()) {
    const bool hasEnvironment = view.lighting && view.lighting->environment;
    report_.contentHash.clear();
    for (const SceneVolume& added : view.added)
      report_.contentHash += contentHash(*known(added.source), added.classification, nullptr) + "-";
    report_.contentHash += contentHash(*view.volume, view.classification, hasEnvironment ? view.lighting->environment.get() : nullptr);
    if (const std::string checksum = source.checksum(); !checksum.empty()) report_.contentHash += "-" + checksum;
  }
  if (options_.drawsShares() && job.holdout) report_.contentHash += "-" + contentHash(*holdoutOf(job));
  if (options_.group == nullptr) return;
  options_.group->agree("another version of the program", programVersion());
  options_.group->agree("another volume, transfer function, environment or holdout", report_.contentHash);
  if (const std::optional<std::string>& flight = options_.scene.description.camera.flight)
    options_.group->agree("another flight", flightText(readFlight(*flight)));
  OptionList options;
  for (const auto& [name, value] : report_.options)
    if (!name.empty()) options.emplace_back(name, value);  // the volume's own name may differ from machine to machine
  options_.group->agree("other options", commandText(options));
}

/// Has the processes of a group draw cube by cube where the volume may not fit on one of them.
void FrameSeries::agreeOnCubes(Renderer& renderer, const VolumeView& view) {
  if (!options_.drawsShares() || options_.shares.coloredParts) return;
  const auto lights = [](const FrameView& frame) { return frame.lights.size(); };
  Scene scene = view.scene;
  scene.show(*std::ranges::max_element(view.frames, {}, lights));  // which takes the most memory
  FrameSettings settings = view.settings;
  settings.lighting = scene.lighting;
  const std::uint64_t fits = renderer.surelyFits(settings) ? 1 : 0;
  if ((options_.group != nullptr ? options_.group->least(fits) : fits) == 0) renderer.requireCubes();
}

void FrameSeries::drawFrames(Renderer& renderer, const VolumeView& view, std::span<const FrameJob> jobs) {
  addTimes(report_.stages, renderer.buildTimings());
  agreeOnCubes(renderer, view);
  Scene scene = view.scene;
  for (std::size_t i = 0; i < jobs.size(); ++i, ++progress_.drawn) {
    if (jobs[i].isSkipped) continue;
    if (options_.group != nullptr && !options_.group->draws(progress_.drawn)) {
      drawnElsewhere_.push_back(&jobs[i]);
      continue;
    }
    scene.show(view.frames[i]);
    FrameSettings settings = view.settings;
    settings.lighting = scene.lighting;
    settings.holdout = holdoutOf(jobs[i]);
    if (options_.drawsShares())
      drawShares(renderer, scene, settings, jobs[i]);
    else
      complete(renderFrame(renderer, device_, options_.scene.description.of(jobs[i].input), scene, settings,
                           options_.scene.description.output.aovs, progress_.progress()),
               isTransparent(renderer), scene, jobs[i]);
    addTimes(report_.stages, renderer.frameTimings());
  }
  finishReduction();
  report(renderer, *scene.volume);
  for (const FrameJob* empty : std::exchange(emptyFramesToWrite_, {})) writeEmpty(*empty);
}

/// Draws a slice, which needs no device.
void FrameSeries::drawSliceOf(const VolumeSource& source, const VolumeView& view, std::span<const FrameJob> jobs) {
  const std::shared_ptr<const Volume> volume = source.whole(progress_.progress());
  for (const FrameJob& job : jobs) {
    if (!job.isSkipped) {
      const StageTimer timer(report_.stages, "draw slice");
      complete(renderSlice(*volume, view.scene, options_.scene.description.camera.size), false, view.scene, job);
    }
    ++progress_.drawn;
  }
  report_.voxels = volume->voxelCount();
  for (const FrameJob* empty : std::exchange(emptyFramesToWrite_, {})) writeEmpty(*empty);
}

/// What ends the rays of a frame; null if nothing does. Neighbouring frames of one image read it once.
const std::shared_ptr<const Holdout>& FrameSeries::holdoutOf(const FrameJob& job) {
  if (job.holdout == holdoutFile_) return holdout_;
  CameraDescription camera = options_.scene.description.camera;
  camera.holdout = job.holdout;
  holdout_ = camera.readHoldout();
  holdoutFile_ = job.holdout;
  return holdout_;
}

/// Draws this process's shares, and hands on or writes their sums or the image of them.
void FrameSeries::drawShares(Renderer& renderer, const Scene& view, const FrameSettings& settings, const FrameJob& job) {
  const SharePart part = options_.group != nullptr ? options_.group->part() : options_.shares.whole();
  const std::optional<int> coloredParts = options_.shares.coloredParts;
  FixedSums sums = coloredParts ? drawColoredParts(renderer, view.camera, settings, *coloredParts, progress_.progress())
                                : renderer.renderShares(view.camera, settings, part, progress_.progress());
  if (options_.group != nullptr) {
    finishReduction();
    pending_ = {&job, view, isTransparent(renderer),
                std::async(std::launch::async, [group = options_.group, sums = std::move(sums)]() mutable {
                  ReducedSums result;
                  const StageTimer timer(result.times, "add up sums");
                  if (group->addUp(sums)) result.sums = std::move(sums);
                  return result;
                })};
  } else if (options_.shares.sums) {
    const StageTimer timer(report_.stages, "write images");
    writer_.writeSums(sums, view, job);
  } else {
    complete(resolveSums(sums, settings.isNormalised()), isTransparent(renderer), view, job);
  }
}

/// Waits for the sums of the group's last frame, and writes its image where they are.
void FrameSeries::finishReduction() {
  if (!pending_.result.valid()) return;
  const ReducedSums added = pending_.result.get();
  addTimes(report_.stages, added.times);
  if (!added.sums) return;
  complete(resolveSums(*added.sums, options_.frameSettings().isNormalised()), pending_.isTransparent, pending_.view, *pending_.job);
}

void FrameSeries::complete(Image image, bool isTransparent, const Scene& view, const FrameJob& job) {
  const std::string name = progress_.frames() == 1 ? "" : job.files.front() + ": ";
  progress_.erase();
  if (const std::string cleared = clearPixelsThatAreNoNumbers(image); !cleared.empty()) spdlog::warn("{}{}", name, cleared);
  if (showsNothing(image))
    spdlog::warn("{}nothing is seen: {}", name, whyNothingIsSeen(isTransparent, options_.scene.description.method.slice.has_value()));
  writer_.write(std::move(image), view, job);
}

void FrameSeries::writeEmpty(const FrameJob& job) {
  if (!film_->reference()) {
    emptyFramesToWrite_.push_back(&job);
    return;
  }
  ++progress_.drawn;
  if (!options_.leads() || job.isSkipped) return;
  Scene view = *film_->reference();
  Volume nothing;
  nothing.source = std::filesystem::path(job.input).filename().string();
  view.volume = std::make_shared<const Volume>(std::move(nothing));
  view.classification.emission.reset();
  writer_.write(emptyImage(options_.frameSettings()), view, job);
}

/// The report describes the last volume.
void FrameSeries::report(const Renderer& renderer, const Volume& volume) {
  logCubes(renderer);
  report_.visibleVoxels = renderer.occupiedVoxelCount();
  report_.voxels = volume.voxelCount();
  report_.memory = renderer.memory();
  report_.cut = renderer.cutCounts();
  report_.scattering = renderer.scattering();
}

}  // namespace freevoxels
