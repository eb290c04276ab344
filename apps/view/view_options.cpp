#include "apps/view/view_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "apps/common/frame_names.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr const char* kFirstVolume = "procedural:cloud";
constexpr int kMaxFrames = 1'000'000;

}  // namespace

void ViewOptions::add(CLI::App& app) {
  for (const char* section : {"input", "volumes", "output", "classification", "emission", "camera", "light"})
    scene.addSection(app, section);
  app.get_option("--tone-map")
      ->description(
          "How bright light is brought into the range of the screen, a .png or a .jpg [filmic where it may be brighter than that, else "
          "none: it is clipped]");
  scene.addFile(app);
  scene.addMethod(app);
  device.add(app);
  addText(app, "--show-on", "INDEX|NAME|UUID|auto", showOn,
          "Device that draws the window, which shows the images of --device [auto: the same, or the CPU where that cannot present on this "
          "display]")
      ->group("Device");
  messages.add(app);
  scene.addField(app, "frames", fmt::format("Frames of a turntable that is saved [{}]", kDefaultFrames));
  CLI::Option* const file =
      addText(app, "--screenshot", "FILE.png", screenshot, "Write what the window shows when the image is complete, and quit");
  file->group("Window");
  addWholeNumber(app, "--after", "N", after,
                 "Frames of the window to wait before the screenshot after the image is complete [1]",
                 {1.0, double(kMaxFrames)})
      ->needs(file)
      ->group("Window");
}

std::optional<Sequence> takeVolume(SceneDescription& scene) {
  std::string& volume = scene.input.volume;
  if (volume.empty()) volume = kFirstVolume;
  scene.check();
  if (scene.method.slice) {
    spdlog::warn("the viewer shows the volume, and its slices beside it (key L): --slice is left out");
    scene.method.slice.reset();
  }
  std::optional<Sequence> sequence;
  if (isPattern(volume)) {
    sequence = findSequence(volume);
    volume = sequence->files.front();
  }
  if (!proceduralName(volume) && !std::filesystem::exists(volume))
    fail(ErrorKind::Input, "cannot read '{}': there is no such file; check its name", volume);
  scene.input.fixLevel(std::max(scene.camera.size.x, scene.camera.size.y));
  return sequence;
}

void ViewOptions::prepare() {
  messages.apply();
  scene.applyScene();
  sequence = takeVolume(scene.description);
  if (!screenshot) return;
  if (!isPng(*screenshot))
    fail(ErrorKind::Usage, "'{}' is no image of a window; name it .png", *screenshot);
  checkOutput(*screenshot);
}

}  // namespace freevoxels
