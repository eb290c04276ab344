#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "apps/freevoxels/commands.h"
#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/description/text_values.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

std::string rangeText(const TransferCurves& curves) {
  if (curves.range == TransferCurves::Range::Values) return windowText(curves.window);
  return curves.range == TransferCurves::Range::Usual ? "the usual values of a volume" : "all values of a volume";
}

std::string unitText(const TransferCurves& curves) {
  if (curves.unitDistance) return fmt::format("{:g} world units", *curves.unitDistance);
  return curves.unitShare ? fmt::format("{:g} of the box", *curves.unitShare) : "a voxel";
}

}  // namespace

void ConvertFunctionCommand::add(CLI::App& app) {
  CLI::App* command = app.add_subcommand("convert-tf", "Write a transfer function of another program as JSON of FreeVoxels");
  command->add_option("IN", function_, "Transfer function: a file, FILE:NAME of a file of several, or a preset's name");
  command->add_option("OUT.json", file_, "File to write");
  messages_.add(*command);
  command->footer(
      "Examples:\n"
      "  freevoxels convert-tf presets.xml:CT-Bone bone.json\n"
      "  freevoxels convert-tf viridis viridis.json\n");
  command->callback([this] { run(); });
}

void ConvertFunctionCommand::run() const {
  messages_.apply();
  if (function_.empty() || file_.empty()) fail(ErrorKind::Usage, "convert-tf takes IN and OUT.json: name a transfer function and a file to write");
  if (std::filesystem::path(file_).extension() != ".json")
    fail(ErrorKind::Usage, "'{}' is not named .json, and convert-tf writes JSON; name it so", file_);
  checkOutput(file_);
  checkDistinct({transferFile(function_), file_});
  const TransferCurves curves = readTransferCurves(function_);
  for (const std::string& warning : transferWarnings(function_)) spdlog::warn("{}", warning);
  spdlog::info("over {}: {} points of opacity, for each {}, and {} of colour", rangeText(curves), curves.opacity.size(), unitText(curves),
               curves.color.size());
  writeTextAtomically(file_, transferCurvesJson(curves));
  if (!messages_.quiet) fmt::print("{}\n", file_);
}

}  // namespace freevoxels
