#include "apps/freevoxels/render_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <span>

#include "apps/freevoxels/progress_line.h"
#include "engine/octree/volume_limits.h"
#include "engine/core/error.h"
#include "engine/renderer.h"
#include "engine/volume/content_hash.h"
#include "engine/vulkan/pipeline.h"

namespace freevoxels {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// "frame 3 of 72: ", which starts what is said about one of several frames.
std::string framePrefix(std::size_t frame, std::size_t frames) {
  return frames == 1 ? "" : fmt::format("frame {} of {}: ", frame + 1, frames);
}

std::string whyNothingIsSeen(const Renderer& renderer) {
  if (renderer.occupiedVoxelCount() == 0u) return "all voxels are transparent; raise --density-scale, or change --transfer-function";
  return "the camera looks past the volume, or what it sees is transparent; leave out --camera-position and --look-at to frame it";
}

Progress prefixed(const Progress& progress, const std::string& prefix) {
  if (!progress) return {};
  return [progress, prefix](std::string_view stage, double fraction) {
    progress(fmt::format("{}{}", prefix, stage), fraction);
  };
}

}  // namespace

void RenderOptions::add(CLI::App& app) {
  scene.add(app);
  scene.lighting.addMethod(app);
  method.add(app);
  if (group == nullptr) shares.add(app);
  device.add(app);
  messages.add(app);
  addText(app, "--timings", "FILE.json", timings, "Write options, device and the time of each stage")
      ->group("Messages");
}

FrameSettings RenderOptions::frameSettings() const {
  FrameSettings settings{.size = scene.camera.size, .depth = scene.output.wantsDepth()};
  method.apply(settings);
  return drawsShares() ? sharedSettings(settings) : settings;
}

void RenderOptions::checkShares(const FrameFiles& outputs) const {
  frameSettings();
  if (!shares.sums) return;
  for (const std::vector<std::string>& files : outputs)
    if (files.size() != 1 || !isExr(files.front())) fail(ExitCode::Usage, "--sums writes a single file: name one .exr as OUT");
  if (scene.output.fullFloat) fail(ExitCode::Usage, "--float has no effect on --sums, which lose no bit: leave it out");
}

void RenderOptions::check(const FrameFiles& outputs) const {
  checkShares(outputs);
  if (!leads()) return scene.checkLook();  // other processes may run where the outputs' folders are not
  std::vector<std::string> pictures;
  for (const std::vector<std::string>& files : outputs)
    pictures.insert(pictures.end(), files.begin(), files.end());
  scene.withOutputs(std::move(pictures)).check(timings ? std::vector{*timings} : std::vector<std::string>{});
}

void RenderOptions::run(const FrameFiles& outputs) const {
  const Clock::time_point start = Clock::now();
  messages.apply();
  if (!leads()) spdlog::set_level(spdlog::level::err);
  if (group != nullptr) group->begin();
  check(outputs);

  DeviceOptions chosen = device;
  if (group != nullptr && !chosen.selector) chosen.selector = group->deviceSelector();
  chosen.withDevice([&](const Device& opened) {
    RunReport report;
    report.stages.push_back({"open device", millisecondsSince(start), false});
    draw(opened, outputs, report);
    report.totalMilliseconds = millisecondsSince(start);
    logStages(report);
    if (group != nullptr) group->logStages(report);
    if (!leads()) return;
    scene.save(report.options);
    if (timings) writeTimings(*timings, report);
  });

  if (messages.quiet || !leads()) return;
  for (const std::vector<std::string>& files : outputs)
    for (const std::string& file : files) fmt::print("{}\n", file);
  for (const std::optional<std::string>& file : {scene.file.saved, timings})
    if (file) fmt::print("{}\n", *file);
}

Scene RenderOptions::open(const Device& opened, int level, ProgressLine& line, RunReport& report) const {
  line.begin("reading " + scene.input.input);
  const StageTimer timer(report.stages, "read volume");
  return scene.open(maximumVoxels(opened), level);
}

OptionList RenderOptions::describe(const Scene& view) const {
  OptionList options;
  method.describe(options);
  return scene.describe(view, options);
}

ExrOptions RenderOptions::header(const Scene& view, const std::vector<std::string>& files, const RunReport& report) const {
  // What a file says of its making is how `render` repeats this frame alone.
  std::map<std::string, std::string> facts{{"device", report.device.name}, {"driver", report.device.driver}};
  if (drawsShares()) {
    facts["share"] = sharePartText(shares.whole());
    facts["content"] = report.contentHash;
  }
  return scene.withOutputs(files).header(view, "render", describe(view), facts);
}

/// Fails where the processes of the group would not draw parts of one picture.
void RenderOptions::agree(const RunReport& report) const {
  if (group == nullptr) return;
  group->agree("another version of the program", programVersion());
  group->agree("another volume, transfer function or environment", report.contentHash);
  OptionList options;
  for (const auto& [name, value] : report.options)
    if (!name.empty()) options.emplace_back(name, value);  // the volume's own name may differ from machine to machine
  group->agree("other options", commandText(options));
}

/// The sums of this process, or of its whole group on the process that writes the frame; on the others of the group none.
std::optional<FixedSums> RenderOptions::drawSums(Renderer& renderer, const Camera& camera, const FrameSettings& settings,
                                                 const Progress& progress, RunReport& report) const {
  const SharePart part = group != nullptr ? group->part() : shares.whole();
  FixedSums sums = renderer.renderShares(camera, settings, part, progress);
  if (group == nullptr) return sums;
  const StageTimer timer(report.stages, "add up sums");
  if (group->addUp(sums)) return sums;
  return {};
}

void RenderOptions::drawFrame(Renderer& renderer, const Scene& view, const FrameSettings& settings,
                              const std::vector<std::string>& files, const std::string& prefix, ProgressLine& line,
                              RunReport& report) const {
  const Progress progress = prefixed(line.progress(), prefix);
  Image image;
  std::optional<FixedSums> sums;
  if (drawsShares())
    sums = drawSums(renderer, view.camera, settings, progress, report);
  else
    image = renderer.render(view.camera, settings, progress);
  const std::vector<StageTime> times = renderer.timings();
  addTimes(report.stages, std::span(times).subspan(report.buildStages));
  report.lackedRoomForRays |= renderer.lackedRoomForRays();
  report.lackedRoomForGather |= renderer.lackedRoomForGather();
  if (drawsShares() && !sums) return;

  line.begin(prefix + "writing pictures");
  const StageTimer timer(report.stages, "write pictures");
  const ExrOptions exr = header(view, files, report);
  if (shares.sums) {
    const DeferredInterrupts wholeFile;
    return writeSums(files.front(), *sums, exr);
  }
  if (sums) image = resolveSums(*sums, settings.composite == Composite::Normalised);
  if (std::ranges::none_of(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.0f || pixel.r + pixel.g + pixel.b > 0.0f; }))
    spdlog::warn("{}nothing is seen: {}", prefix, whyNothingIsSeen(renderer));
  scene.withOutputs(files).output.write(image, exr);
}

/// A baked volume is drawn from the finest level that shows and that the device can hold.
void RenderOptions::draw(const Device& opened, const FrameFiles& outputs, RunReport& report) const {
  const FrameSettings settings = frameSettings();
  checkFrameFits(opened, settings);
  const std::shared_ptr<const fvx::FvxFile> file = scene.input.baked();
  const int levels = file ? file->levels() : 1;
  const RunReport before = report;
  for (int level = scene.finestLevelSeen(double(settings.lod), int(outputs.size()));; ++level) {
    try {
      return drawLevel(opened, outputs, level, report);
    } catch (const Error& error) {
      if (error.code() != ExitCode::OutOfMemory || level + 1 >= levels) throw;
      spdlog::warn("{}; drawing it at 1/{} of its resolution", error.what(), 1 << (level + 1));
      report = before;
    }
  }
}

void RenderOptions::drawLevel(const Device& opened, const FrameFiles& outputs, int level, RunReport& report) const {
  FrameSettings settings = frameSettings();
  ProgressLine line(!messages.quiet && leads());
  Scene view = open(opened, level, line, report);
  const std::vector<Camera> cameras = scene.cameras(*view.volume, view.classification, int(outputs.size()));
  view.camera = cameras.front();
  settings.lighting = view.lighting;
  report.device = opened.description();
  report.options = describe(view);
  if (outputs.size() > 1) {
    scene.camera.describeTurn(report.options);
    report.options.emplace_back("--frames", fmt::format("{}", outputs.size()));
  }
  line.erase();
  scene.warn(view);
  logOptions(report.options);
  mentionCpu(opened);
  if (drawsShares())
    report.contentHash = contentHash(*view.volume, view.classification,
                                     view.lighting && view.lighting->environment ? view.lighting->environment.get() : nullptr);
  agree(report);

  Renderer renderer(opened, *view.volume, view.classification, method.table(), line.progress());
  const std::vector<StageTime> built = renderer.timings();
  addTimes(report.stages, built);
  report.buildStages = built.size();
  for (std::size_t frame = 0; frame < outputs.size(); ++frame) {
    if (group != nullptr && !group->draws(frame)) continue;
    view.camera = cameras[frame];
    drawFrame(renderer, view, settings, outputs[frame], framePrefix(frame, outputs.size()), line, report);
  }
  addTimes(report.stages, opened.pipelines().times);
  report.visibleVoxels = renderer.occupiedVoxelCount();
  report.voxels = view.volume->voxelCount();
  report.memory = renderer.memory();
  report.devicePeak = opened.peakBytes();
  report.cut = renderer.cutCounts();
}

}  // namespace freevoxels
