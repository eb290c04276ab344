#include "apps/common/render_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "apps/common/frame_series.h"
#include "apps/common/kept_renderer.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"
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
  addText(app, "--timings", "FILE.json", timings, "Write options, device and the time of each stage")->group("Messages");
}

void RenderOptions::addSkipExisting(CLI::App& app) {
  if (group != nullptr) return;  // its processes need not see the same files
  app.add_flag("--skip-existing", skipsExisting, "Leave frames out whose images all exist already, as after an interrupted run")
      ->group("Sequence");
}

/// A file that exists is complete (core/atomic_file.h).
void RenderOptions::skipExisting(std::span<FrameJob> frames) const {
  if (!skipsExisting) return;
  std::size_t existing = 0;
  for (FrameJob& frame : frames) {
    if (usesStandardOutput(frame.files))
      fail(ErrorKind::Usage, "--skip-existing looks for images that exist, and - has no name: leave one of them out");
    std::error_code unreadable;
    const bool exists =
        std::ranges::all_of(frame.files, [&](const std::string& file) { return std::filesystem::exists(file, unreadable); });
    if (exists && !frame.isSkipped) ++existing;
    frame.isSkipped |= exists;
  }
  if (existing > 0) spdlog::info("{} of {} frames exist and stay as they are", existing, frames.size());
}

FrameSettings RenderOptions::frameSettings() const {
  const FrameSettings settings = freevoxels::frameSettings(scene.description, scene.description.output.aovs.needDepth());
  return drawsShares() ? sharedSettings(settings) : settings;
}

void RenderOptions::checkShares(std::span<const FrameJob> frames) const {
  frameSettings();
  shares.check();
  if (drawsShares() && scene.description.output.aovs.hasLayers())
    fail(ErrorKind::Usage, "{} are made of whole frames, which processes do not share: draw them by one", Parameter("aov", "lights"));
  if (drawsShares() && scene.description.method.slice)
    fail(ErrorKind::Usage, "a slice is drawn by one process, at once: leave {} out, or draw it with 'freevoxels render'",
         Parameter("slice"));
  if (!shares.sums) return;
  if (scene.description.method.annotate)
    fail(ErrorKind::Usage, "{} draws over an image, and --sums writes a part of one: leave it out", Parameter("annotate"));
  for (const FrameJob& frame : frames)
    if (frame.files.size() != 1 || !isExr(frame.files.front())) fail(ErrorKind::Usage, "--sums writes a single file: name one .exr as OUT");
  if (scene.description.output.fullFloat) fail(ErrorKind::Usage, "--float has no effect on --sums, which lose no bit: leave it out");
}

void RenderOptions::check(std::span<const FrameJob> frames) const {
  checkShares(frames);
  if (!leads()) return scene.description.check();  // other processes may run where the outputs' folders are not
  std::vector<std::string> images, inputs;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (std::ranges::count(frames[i].files, kStandardOutput) > 1) fail(ErrorKind::Usage, "- is named twice: name it once");
    images.insert(images.end(), frames[i].files.begin(), frames[i].files.end());
    if (i > 0 && frames[i].input != frames[i - 1].input) inputs.push_back(frames[i].input);
    if (frames[i].holdout && (i == 0 || frames[i].holdout != frames[i - 1].holdout)) {
      if (!frames[i].isSkipped) checkInputFile("holdout", *frames[i].holdout);
      inputs.push_back(*frames[i].holdout);
    }
  }
  SceneOptions first = scene;
  first.description.input.volume = frames.front().input;
  first.check(images, timings ? std::vector{*timings} : std::vector<std::string>{}, inputs);
}

void RenderOptions::run(std::vector<FrameJob> frames) const {
  const Clock::time_point start = Clock::now();
  messages.apply();
  if (!leads()) spdlog::set_level(spdlog::level::err);
  if (group != nullptr) group->begin();
  check(frames);
  skipExisting(frames);
  const bool drawsNothing = std::ranges::all_of(frames, &FrameJob::isSkipped);
  if (drawsNothing && !scene.saved && !timings) return;

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

  if (messages.quiet || !leads() || std::ranges::any_of(frames, [](const FrameJob& frame) { return usesStandardOutput(frame.files); }))
    return;
  for (const std::optional<std::string>& file : {scene.saved, timings})
    if (file) fmt::print("{}\n", *file);
}

}  // namespace freevoxels
