#include "apps/common/bake_command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "apps/common/bake.h"
#include "apps/common/progress_line.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Shows progress, and defers interrupts from when the file exists under a temporary name.
class BakeProgress {
 public:
  explicit BakeProgress(ProgressLine& line) : shown_(line.progress()) {}
  Progress progress() {
    return [this](std::string_view stage, double fraction) {
      if (stage == kWritingStage) wholeFile_.emplace();
      if (shown_) shown_(stage, fraction);
    };
  }

 private:
  Progress shown_;
  std::optional<DeferredInterrupts> wholeFile_;
};

}  // namespace

void BakeCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("bake", "Classify a volume once and write a file that opens at once");
  scene_.addFields(*command, {"volume", "resolution", "grid", "raw", "series", "time-step", "spacing", "pyramid-level", "no-data"});
  command->add_option("OUT.fvx", file_, "File to write")->group("Output");
  for (const char* section : {"classification", "emission"}) scene_.addSection(*command, section);
  command
      ->add_flag("--keep-scalars", keepScalars_,
                 "Store the values as 32-bit floats, so that the classification can still be changed [16 bits a value, for this "
                 "classification alone]")
      ->group("Output");
  command->add_flag("--compress", compress_, "Compress with Zstandard: smaller, and slower to open")->group("Output");
  messages_.add(*command);
  command->footer(
      "Every command that takes a .vdb takes OUT.fvx in its place.\n"
      "Examples:\n"
      "  freevoxels bake cloud.vdb cloud.fvx --density-scale 40\n"
      "  freevoxels bake scan.vdb scan.fvx --transfer-function bone.json --keep-scalars\n"
      "  freevoxels bake procedural:cloud cloud.fvx --resolution 512 --compress\n");
  command->callback([this] { run(); });
}

void BakeCommand::run() {
  messages_.apply();
  if (!leads()) spdlog::set_level(spdlog::level::err);
  if (group_ != nullptr) group_->begin();
  scene_.description.input.checkGiven();
  if (file_.empty()) fail(ErrorKind::Usage, "OUT.fvx is required: name a file to write");
  const BakeRequest request{
      .scene = scene_.description, .file = file_, .keepScalars = keepScalars_, .compress = compress_, .group = group_};
  checkBake(request);

  ProgressLine line(!messages_.quiet && leads());
  line.begin("reading " + scene_.description.input.volume);
  BakeProgress progress(line);
  const auto remarks = [&](const Scene& scene) {
    line.erase();
    logRemarks(scene_.description, scene);
  };
  bakeScene(request, remarks, progress.progress());
  line.erase();
  if (!messages_.quiet && leads()) fmt::print("{}\n", file_);
}

}  // namespace freevoxels
