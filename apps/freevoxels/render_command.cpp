#include "apps/freevoxels/render_command.h"

#include <CLI/CLI.hpp>
#include <chrono>

#include "apps/freevoxels/progress_line.h"
#include "engine/renderer.h"

namespace freevoxels {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  freevoxels render cloud.vdb cloud.exr cloud.png\n"
    "  freevoxels render smoke.vdb smoke.png --orbit 120,10 --size 1920x1080 --background 0.02,0.03,0.05\n"
    "  freevoxels render procedural:shells shells.png --resolution 200 --transfer-function shells.json\n"
    "  freevoxels render cloud.vdb paper.png --paper --density-scale 40 --albedo 0.9,0.8,0.7\n";

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

void RenderCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("render", "Draw a volume into pictures");
  scene_.add(*command);
  method_.add(*command);
  device_.add(*command);
  messages_.add(*command);
  addText(*command, "--timings", "FILE.json", timings_, "Write options, device and the time of each stage")
      ->group("Messages");
  command->footer(kExamples);
  command->callback([this] { run(); });
}

void RenderCommand::run() const {
  const Clock::time_point start = Clock::now();
  messages_.apply();
  scene_.check(timings_ ? std::vector{*timings_} : std::vector<std::string>{});

  device_.withDevice([&](const Device& device) {
    RunReport report;
    report.stages.push_back({"open device", millisecondsSince(start), false});
    draw(device, report);
    report.totalMilliseconds = millisecondsSince(start);
    logStages(report);
    if (timings_) writeTimings(*timings_, report);
  });

  if (messages_.quiet) return;
  for (const std::string& file : scene_.output.files) fmt::print("{}\n", file);
  if (timings_) fmt::print("{}\n", *timings_);
}

void RenderCommand::draw(const Device& device, RunReport& report) const {
  FrameSettings frame{.size = scene_.camera.size, .depth = scene_.output.wantsDepth()};
  method_.apply(frame);
  checkFrameFits(device, frame);

  ProgressLine line(!messages_.quiet);
  line.begin("reading " + scene_.input.input);
  const Scene scene = [&] {
    const StageTimer timer(report.stages, "read volume");
    return scene_.open(maximumVoxels(device, method_.table().directions));
  }();
  OptionList method;
  method_.describe(method);
  report.device = device.description();
  report.options = scene_.describe(scene, method);
  line.erase();
  scene_.warn(scene);
  logOptions(report.options);
  mentionCpu(device);

  Renderer renderer(device, scene.volume, scene.classification, method_.table(), line.progress());
  const Image image = renderer.render(scene.camera, frame, line.progress());
  const std::vector<StageTime> times = renderer.timings();
  report.stages.insert(report.stages.end(), times.begin(), times.end());
  report.visibleVoxels = renderer.visibleVoxelCount();

  line.begin("writing pictures");
  const StageTimer timer(report.stages, "write pictures");
  scene_.write(image, scene, "render", report.options,
               {{"device", report.device.name}, {"driver", report.device.driver}});
}

}  // namespace freevoxels
