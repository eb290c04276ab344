#include <CLI/CLI.hpp>
#include <optional>

#include "apps/common/convert.h"
#include "apps/common/progress_line.h"
#include "apps/freevoxels/commands.h"
#include "engine/core/error.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

void ConvertCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("convert", "Write the values of a volume to a file of another format");
  scene_.addFields(*command,
                   {"volume", "resolution", "grid", "raw", "series", "time-step", "spacing", "pyramid-level", "no-data", "clip-box"});
  scene_.addFile(*command);
  command->add_option("OUT", file_, "File to write, .vdb, .nrrd, .nii or .nii.gz")->group("Output");
  messages_.add(*command);
  command->footer(
      "Values are those before a classification, as 32-bit floats, in their place in the world. The channels of a scan become grids of a\n"
      ".vdb; --grid chooses one of them.\n"
      "Examples:\n"
      "  freevoxels convert ct/ ct.nii.gz\n"
      "  freevoxels convert cells.ome.zarr cells.vdb --pyramid-level 1\n"
      "  freevoxels convert smoke.vdb smoke.nrrd --grid density\n");
  command->callback([this] { run(); });
}

void ConvertCommand::run() {
  messages_.apply();
  scene_.applyScene();
  const InputDescription& input = scene_.description.input;
  input.checkGiven();
  if (file_.empty()) fail(ErrorKind::Usage, "OUT is required: name a file to write, .vdb, .nrrd, .nii or .nii.gz");
  checkConvert(input, file_);
  ProgressLine line(!messages_.quiet);
  line.begin("reading " + input.volume);
  const Progress shown = line.progress();
  {
    std::optional<DeferredInterrupts> wholeFile;
    const auto remarks = [&](const Volume& volume) {
      line.erase();
      logWarnings(volume, false);
      logAssumptions(volume);
    };
    convertVolume(input, file_, remarks, [&](std::string_view stage, double fraction) {
      if (stage == kWritingStage && !wholeFile) wholeFile.emplace();
      if (shown) shown(stage, fraction);
    });
  }
  line.erase();
  if (!messages_.quiet) fmt::print("{}\n", file_);
}

}  // namespace freevoxels
