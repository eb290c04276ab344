// The command-line program: freevoxels render | turntable | merge | oracle | compare | info | convert | generate | bake | presets |
// convert-tf | devices.

#include <CLI/CLI.hpp>

#include "apps/common/bake_command.h"
#include "apps/common/program.h"
#include "apps/common/render_command.h"
#include "apps/common/turntable_command.h"
#include "apps/freevoxels/commands.h"

int main(int argc, char** argv) {
  CLI::App app("Draws volumes: clouds, smoke, fire and scans, with shadows.", "freevoxels");
  freevoxels::RenderCommand render;
  freevoxels::TurntableCommand turntable;
  freevoxels::MergeCommand merge;
  freevoxels::OracleCommand oracle;
  freevoxels::CompareCommand compare;
  freevoxels::InfoCommand info;
  freevoxels::ConvertCommand convert;
  freevoxels::GenerateCommand generate;
  freevoxels::BakeCommand bake;
  freevoxels::PresetsCommand presets;
  freevoxels::ConvertFunctionCommand convertFunction;
  freevoxels::DevicesCommand devices;
  render.add(app);
  turntable.add(app);
  merge.add(app);
  oracle.add(app);
  compare.add(app);
  info.add(app);
  convert.add(app);
  generate.add(app);
  bake.add(app);
  presets.add(app);
  convertFunction.add(app);
  devices.add(app);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  freevoxels generate cloud cloud.vdb --resolution 128\n"
      "  freevoxels info cloud.vdb\n"
      "  freevoxels render cloud.vdb cloud.png\n"
      "'freevoxels COMMAND --help' has the options of a command.\n"
      "Exit codes: 0 done, 1 internal error, 2 usage, 3 input, 4 output, 5 device, 6 out of memory, "
      "7 images differ.");
  return freevoxels::runProgram(app, argc, argv);
}
