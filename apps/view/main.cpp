// The viewer: freevoxels-view [IN].

#include <CLI/CLI.hpp>

#include "apps/freevoxels/program.h"
#include "apps/view/view_options.h"
#include "apps/view/viewer.h"
#include "apps/view/window.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Shows a volume in a window, where all options can be changed, and writes the equivalent command line.",
      "freevoxels-view");
  freevoxels::ViewOptions options;
  options.add(app);
  app.footer(
      "Examples:\n"
      "  freevoxels-view cloud.vdb\n"
      "  freevoxels-view procedural:head --transfer-function apps/transfer_functions/bone.json\n"
      "  freevoxels-view smoke_####.vdb\n"
      "  freevoxels-view --scene apps/scenes/cloud.json --screenshot window.png\n"
      "Drag to turn, with Shift to pan, with Ctrl or the wheel to come nearer, with the right button to look "
      "around; W A S D Q E fly, F frames the volume, 1 to 6 look along the axes, O changes the projection, "
      "Space "
      "plays a sequence. Ctrl+O opens a file (or drop it onto the window), Ctrl+S saves the picture, Ctrl+E "
      "the "
      "scene, Ctrl+T a turn, and Escape gives that up; Ctrl+Q ends.\n"
      "Exit codes: as of 'freevoxels'.");
  app.callback([&options] {
    options.prepare();
    const freevoxels::WindowSystem windows;
    freevoxels::withInstance(
        [&](const freevoxels::Instance& instance) { freevoxels::Viewer(windows, instance, options).run(); },
        windows.instanceExtensions());
  });
  return freevoxels::runProgram(app, argc, argv);
}
