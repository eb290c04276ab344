#include "apps/view/view_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr const char* kFirstVolume = "procedural:cloud";
constexpr int kMostFrames = 1'000'000;

}  // namespace

void ViewOptions::add(CLI::App& app) {
  scene.input.add(app);
  scene.input.addGrid(app);
  scene.output.addBackground(app);
  scene.addLook(app);
  scene.lighting.addMethod(app);
  method.add(app);
  device.add(app);
  messages.add(app);
  CLI::Option* const file =
      addText(app, "--screenshot", "FILE.png", screenshot, "Writes what the window shows, and ends");
  file->group("Window");
  addWholeNumber(app, "--after", "N", after,
                 "Frames of the window to wait before the screenshot when the picture is complete [1]",
                 {1.0, double(kMostFrames)})
      ->needs(file)
      ->group("Window");
}

void ViewOptions::prepare() {
  messages.apply();
  scene.file.apply([](const std::string&) { return true; });
  if (scene.input.input.empty()) scene.input.input = kFirstVolume;
  scene.checkLook();
  if (!proceduralName(scene.input.input) && !std::filesystem::exists(scene.input.input))
    fail(ExitCode::Input, "cannot read '{}': there is no such file; check its name", scene.input.input);
  if (screenshot) {
    if (!isPng(*screenshot))
      fail(ExitCode::Usage, "'{}' is not a picture of a window; name it .png", *screenshot);
    checkOutput(*screenshot);
  }
}

}  // namespace freevoxels
