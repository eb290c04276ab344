#include "apps/freevoxels/render_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "apps/freevoxels/frame_series.h"
#include "engine/core/error.h"
#include "engine/renderer.h"

namespace freevoxels {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

void RenderOptions::add(CLI::App& app) {
  scene.add(app);
  scene.addMethod(app);
  if (group == nullptr) shares.add(app);
  device.add(app);
  messages.add(app);
  addText(app, "--timings", "FILE.json", timings, "Write options, device and the time of each stage")
      ->group("Messages");
}

FrameSettings RenderOptions::frameSettings() const {
  FrameSettings settings{.size = scene.description.camera.size, .depth = scene.description.output.aovs.needDepth()};
  scene.description.method.apply(settings);
  return drawsShares() ? sharedSettings(settings) : settings;
}

SceneDescription RenderOptions::sceneOf(const std::string& volume) const {
  SceneDescription result = scene.description;
  result.input.volume = volume;
  return result;
}

void RenderOptions::checkShares(std::span<const FrameJob> frames) const {
  frameSettings();
  shares.check();
  if (!shares.sums) return;
  for (const FrameJob& frame : frames)
    if (frame.files.size() != 1 || !isExr(frame.files.front()))
      fail(ErrorKind::Usage, "--sums writes a single file: name one .exr as OUT");
  if (scene.description.output.fullFloat) fail(ErrorKind::Usage, "--float has no effect on --sums, which lose no bit: leave it out");
}

void RenderOptions::check(std::span<const FrameJob> frames) const {
  checkShares(frames);
  if (!leads()) return scene.description.check();  // other processes may run where the outputs' folders are not
  std::vector<std::string> images, volumes;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    images.insert(images.end(), frames[i].files.begin(), frames[i].files.end());
    if (i > 0 && frames[i].input != frames[i - 1].input) volumes.push_back(frames[i].input);
  }
  SceneOptions first = scene;
  first.description.input.volume = frames.front().input;
  first.check(images, timings ? std::vector{*timings} : std::vector<std::string>{}, volumes);
}

void RenderOptions::run(std::span<const FrameJob> frames) const {
  const Clock::time_point start = Clock::now();
  messages.apply();
  if (!leads()) spdlog::set_level(spdlog::level::err);
  if (group != nullptr) group->begin();
  check(frames);

  DeviceOptions chosen = device;
  if (group != nullptr && !chosen.selector) chosen.selector = group->deviceSelector();
  chosen.withDevice([&](const Device& opened) {
    RunReport report;
    report.stages.push_back({"open device", millisecondsSince(start), false});
    // Where a limit is the reason, one sentence says what volume and image need together (withWholeNeed).
    if (opened.memoryBytes() >= opened.description().memoryBytes) checkFrameFits(opened, frameSettings());
    FrameSeries series(*this, opened, report);
    series.draw(frames);
    report.totalMilliseconds = millisecondsSince(start);
    logStages(report);
    if (group != nullptr) group->logStages(report);  // when all processes have written their frames
    series.printDrawnElsewhere();
    if (!leads()) return;
    scene.save(report.scene);
    if (timings) writeTimings(*timings, report);
  });

  if (messages.quiet || !leads()) return;
  for (const std::optional<std::string>& file : {scene.saved, timings})
    if (file) fmt::print("{}\n", *file);
}

}  // namespace freevoxels
