#include "apps/freevoxels/bake_command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/freevoxels/progress_line.h"
#include "engine/core/error.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

void BakeCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("bake", "Classify a volume once and write a file that opens at once");
  scene_.input.add(*command);
  scene_.input.addGrid(*command);
  command->add_option("OUT.fvx", file_, "File to write")->group("Output");
  scene_.classification.add(*command);
  scene_.emission.add(*command);
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

std::string BakeCommand::provenance(const Volume& volume, const Classification& classification) const {
  OptionList options;
  scene_.input.describe(options);
  scene_.classification.describe(options, volume, classification);
  scene_.emission.describe(options, volume, classification.emission);
  nlohmann::ordered_json json{{"program", "freevoxels " + programVersion()}, {"volume", volume.source}};
  for (const auto& [name, value] : optionMap(options)) json["options"][name] = value;
  if (!proceduralName(scene_.input.input)) {
    json["file_bytes"] = std::filesystem::file_size(scene_.input.input);
    json["file_xxh3_64"] = fmt::format("{:016x}", fvx::hashOfFile(scene_.input.input));
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void BakeCommand::run() {
  messages_.apply();
  scene_.input.checkGiven();
  if (file_.empty()) fail(ExitCode::Usage, "OUT.fvx is required: name a file to write");
  if (std::filesystem::path(file_).extension() != ".fvx")
    fail(ExitCode::Usage, "'{}' is not named .fvx, and bake writes baked volumes; name it so", file_);
  scene_.checkLook();
  checkOutput(file_);
  if (!proceduralName(scene_.input.input)) checkDistinct({scene_.input.input, file_});

  ProgressLine line(!messages_.quiet);
  line.begin("reading " + scene_.input.input);
  const Volume volume = scene_.readVolume(machineMemoryBytes() / sizeof(float));
  if (volume.classificationIsFixed)
    fail(ExitCode::Usage, "'{}' was baked for one classification: bake the volume that it was made of, or bake it with --keep-scalars",
         scene_.input.input);
  const Scene scene{.volume = std::make_shared<const Volume>(volume), .classification = scene_.resolveClassification(volume)};
  line.erase();
  scene_.warn(scene);
  {
    const DeferredInterrupts wholeFile;
    bakeVolume(file_, volume, scene.classification,
               {.keepScalars = keepScalars_, .compress = compress_, .provenance = provenance(volume, scene.classification)},
               line.progress());
  }
  line.erase();
  if (!messages_.quiet) fmt::print("{}\n", file_);
}

}  // namespace freevoxels
