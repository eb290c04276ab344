// The viewer: freevoxels-view [IN].

#include <CLI/CLI.hpp>

#include "apps/common/program.h"
#include "apps/view/view_options.h"
#include "apps/view/viewer.h"
#include "apps/view/window.h"
#include "apps/view/window_devices.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Shows a volume in a window, where all options can be changed, and writes the equivalent command line.",
      "freevoxels-view");
  freevoxels::ViewOptions options;
  options.add(app);
  bool triesPresentation = false;
  app.add_flag(freevoxels::kTryPresentation, triesPresentation)->group("");
  app.footer(
      "Examples:\n"
      "  freevoxels-view cloud.vdb\n"
      "  freevoxels-view procedural:head --transfer-function apps/transfer_functions/bone.json\n"
      "  freevoxels-view smoke_####.vdb\n"
      "  freevoxels-view --scene apps/scenes/cloud.json --screenshot window.png\n"
      "Drag to turn, Shift + drag to pan, wheel to come nearer. Ctrl+O opens a file, Ctrl+S saves the image, Ctrl+Z undoes an "
      "edit; F1 lists all keys.\n"
      "Exit codes: as of 'freevoxels'.");
  app.callback([&options, &triesPresentation] {
    if (triesPresentation) return freevoxels::tryPresentation(options.device);
    options.prepare();
    const freevoxels::WindowSystem windows;
    freevoxels::withInstance(
        [&](const freevoxels::Instance& instance) { freevoxels::Viewer(windows, instance, options).run(); },
        windows.instanceExtensions());
  });
  return freevoxels::runProgram(app, argc, argv);
}
