#include "apps/freevoxels/render_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <span>

#include "apps/freevoxels/background_writer.h"
#include "apps/freevoxels/progress_line.h"
#include "engine/octree/volume_limits.h"
#include "engine/renderer.h"
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
  device.add(app);
  messages.add(app);
  addText(app, "--timings", "FILE.json", timings, "Write options, device and the time of each stage")
      ->group("Messages");
}

void RenderOptions::check(const FrameFiles& outputs) const {
  std::vector<std::string> pictures;
  for (const std::vector<std::string>& files : outputs)
    pictures.insert(pictures.end(), files.begin(), files.end());
  scene.withOutputs(std::move(pictures)).check(timings ? std::vector{*timings} : std::vector<std::string>{});
}

void RenderOptions::run(const FrameFiles& outputs) const {
  const Clock::time_point start = Clock::now();
  messages.apply();
  check(outputs);

  device.withDevice([&](const Device& opened) {
    RunReport report;
    report.stages.push_back({"open device", millisecondsSince(start), false});
    draw(opened, outputs, report);
    report.totalMilliseconds = millisecondsSince(start);
    logStages(report);
    scene.save(report.options);
    if (timings) writeTimings(*timings, report);
  });

  if (messages.quiet) return;
  for (const std::vector<std::string>& files : outputs)
    for (const std::string& file : files) fmt::print("{}\n", file);
  for (const std::optional<std::string>& file : {scene.file.saved, timings})
    if (file) fmt::print("{}\n", *file);
}

Scene RenderOptions::open(const Device& opened, ProgressLine& line, RunReport& report) const {
  line.begin("reading " + scene.input.input);
  const StageTimer timer(report.stages, "read volume");
  return scene.open(maximumVoxels(opened));
}

OptionList RenderOptions::describe(const Scene& view) const {
  OptionList options;
  method.describe(options);
  return scene.describe(view, options);
}

void RenderOptions::write(const Image& image, const Scene& view, const std::vector<std::string>& files,
                          const DeviceDescription& description) const {
  // What a file says of its making is how `render` repeats this frame alone.
  scene.withOutputs(files).write(image, view, "render", describe(view),
                                 {{"device", description.name}, {"driver", description.driver}});
}

void RenderOptions::draw(const Device& opened, const FrameFiles& outputs, RunReport& report) const {
  FrameSettings settings{.size = scene.camera.size, .depth = scene.output.wantsDepth()};
  method.apply(settings);
  checkFrameFits(opened, settings);

  ProgressLine line(!messages.quiet);
  Scene view = open(opened, line, report);
  const std::vector<Camera> cameras = scene.camera.resolve(*view.volume, view.classification, int(outputs.size()));
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

  Renderer renderer(opened, *view.volume, view.classification, method.table(), line.progress());
  const std::vector<StageTime> built = renderer.timings();
  addTimes(report.stages, built);
  BackgroundWriter writer;
  for (std::size_t frame = 0; frame < outputs.size(); ++frame) {
    view.camera = cameras[frame];
    const std::string prefix = framePrefix(frame, outputs.size());
    Image image = renderer.render(view.camera, settings, prefixed(line.progress(), prefix));
    if (std::ranges::none_of(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.0f || pixel.r + pixel.g + pixel.b > 0.0f; }))
      spdlog::warn("{}nothing is seen: {}", prefix, whyNothingIsSeen(renderer));
    const std::vector<StageTime> times = renderer.timings();
    addTimes(report.stages, std::span(times).subspan(built.size()));
    report.lackedRoomForRays |= renderer.lackedRoomForRays();
    report.lackedRoomForGather |= renderer.lackedRoomForGather();

    line.begin(prefix + "writing pictures");
    writer.start([this, image = std::move(image), view, &files = outputs[frame], &device = report.device] {
      write(image, view, files, device);
    });
  }
  writer.finish();
  addTimes(report.stages, writer.times());
  addTimes(report.stages, opened.pipelines().times());
  report.visibleVoxels = renderer.occupiedVoxelCount();
  report.voxels = view.volume->voxelCount();
  report.memory = renderer.memory();
  report.devicePeak = opened.peakBytes();
  report.cut = renderer.cutCounts();
}

}  // namespace freevoxels
