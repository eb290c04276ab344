#include "apps/common/bake_command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/common/progress_line.h"
#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/storage/procedural_stream.h"
#include "engine/volume/content_hash.h"

namespace freevoxels {

namespace {

/// A procedural volume of more voxels is made chunk by chunk.
constexpr std::uint64_t kMaxVoxelsInMemory = std::uint64_t(1) << 27;
/// Voxels along the longest edge of the same volume from which the classification is then found.
constexpr int kSampleEdge = 256;
/// A volume of a file whose values take more is read part by part.
constexpr std::uint64_t kMaxBytesInMemory = std::uint64_t(1) << 30;

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
  scene_.addFields(*command, {"volume", "resolution", "grid"});
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

BakeSettings BakeCommand::settings(const Volume& volume, const Classification& classification) const {
  const Scene scene{.volume = std::shared_ptr<const Volume>(std::shared_ptr<const Volume>(), &volume), .classification = classification};
  const OptionList options = scene_.ownOptions(scene_.description.resolved(scene));
  nlohmann::ordered_json json{{"program", "freevoxels " + programVersion()}, {"volume", volume.source}};
  for (const auto& [name, value] : optionMap(options)) json["options"][name] = value;
  if (!proceduralName(scene_.description.input.volume)) {
    json["file_bytes"] = std::filesystem::file_size(scene_.description.input.volume);
    json["file_xxh3_64"] = fmt::format("{:016x}", fvx::hashOfFile(scene_.description.input.volume));
  }
  return {.keepScalars = keepScalars_,
          .compress = compress_,
          .provenance = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)};
}

void BakeCommand::agree(const std::string& content, const BakeSettings& settings) const {
  if (group_ == nullptr) return;
  group_->agree("another version of the program", programVersion());
  group_->agree("another volume or transfer function", content);
  nlohmann::json provenance = nlohmann::json::parse(settings.provenance);
  provenance.erase("volume");  // the volume's own name may differ from machine to machine
  provenance["options"].erase("input");
  group_->agree("other options", fmt::format("{} {} {}", settings.keepScalars, settings.compress, provenance.dump()));
}

BakeTeam BakeCommand::team() const {
  if (group_ == nullptr) return {};
  const SharePart place = group_->place();
  return {
      .index = place.index, .count = place.count, .bring = [this](std::vector<std::byte>& bytes, int from) { group_->bring(bytes, from); }};
}

void BakeCommand::run() {
  messages_.apply();
  if (!leads()) spdlog::set_level(spdlog::level::err);
  if (group_ != nullptr) group_->begin();
  scene_.description.input.checkGiven();
  if (file_.empty()) fail(ErrorKind::Usage, "OUT.fvx is required: name a file to write");
  if (std::filesystem::path(file_).extension() != ".fvx")
    fail(ErrorKind::Usage, "'{}' is not named .fvx, and bake writes baked volumes; name it so", file_);
  scene_.description.check();
  if (leads()) checkOutput(file_);
  if (!proceduralName(scene_.description.input.volume)) checkDistinct({scene_.description.input.volume, file_});

  ProgressLine line(!messages_.quiet && leads());
  line.begin("reading " + scene_.description.input.volume);
  const std::optional<std::string> name = proceduralName(scene_.description.input.volume);
  const glm::u64vec3 size(scene_.description.input.resolution.value_or(glm::ivec3(kDefaultResolution)));
  if (name && size.x * size.y * size.z > kMaxVoxelsInMemory)
    bakeProcedural(*name, line);
  else if (name || !bakeParts(line))
    bake(line);
  line.erase();
  if (!messages_.quiet && leads()) fmt::print("{}\n", file_);
}

void BakeCommand::bake(ProgressLine& line) const {
  const auto volume = std::make_shared<const Volume>(scene_.description.readVolume(machineMemoryBytes() / sizeof(float)));
  if (volume->classificationIsFixed)
    fail(ErrorKind::Usage, "'{}' was baked for one classification: bake the volume that it was made of, or bake it with --keep-scalars",
         scene_.description.input.volume);
  const Classification classification = scene_.description.resolveClassification(*volume);
  line.erase();
  logRemarks(scene_.description, {.volume = volume, .classification = classification});
  BakeProgress progress(line);
  const BakeSettings chosen = settings(*volume, classification);
  if (group_ != nullptr) agree(contentHash(*volume, classification, nullptr), chosen);
  bakeVolume(file_, *volume, classification, chosen, progress.progress(), team());
}

void BakeCommand::bakeProcedural(const std::string& name, ProgressLine& line) const {
  const ProceduralField field(name, *scene_.description.input.resolution);
  const glm::ivec3 size = field.dimensions();
  const int factor = (std::max({size.x, size.y, size.z}) + kSampleEdge - 1) / kSampleEdge;
  Volume sample = makeProcedural(name, glm::max(size / factor, 1));
  if (!scene_.description.emission.grid()) sample.temperature.reset();
  const Classification classification = scene_.description.resolveClassification(sample);
  bakeStream(proceduralStream(field, sample, classification), sample, classification, line);
}

bool BakeCommand::bakeParts(ProgressLine& line) const {
  const SceneDescription& description = scene_.description;
  if (fvx::isFvx(description.input.volume)) return false;
  const std::unique_ptr<const VdbParts> parts =
      VdbParts::open(description.input.volume,
                     {.grid = description.input.grid.value_or(""),
                      .more = {.temperature = description.emission.grid(), .albedo = description.classification.grid()},
                      .noData = description.input.noData},
                     kMaxBytesInMemory);
  if (!parts) return false;
  const Classification classification = description.resolveClassification(parts->sample());
  line.erase();
  logRemarks(description, {.volume = std::make_shared<const Volume>(parts->sample()), .classification = classification});
  bakeStream(partsStream(*parts, classification), parts->sample(), classification, line);
  return true;
}

void BakeCommand::bakeStream(const StreamedVolume& stream, const Volume& sample, const Classification& classification,
                             ProgressLine& line) const {
  BakeProgress progress(line);
  const BakeSettings chosen = settings(sample, classification);
  if (group_ != nullptr) agree(contentHash(sample, classification, nullptr), chosen);
  bakeStreamed(file_, stream, classification, chosen, progress.progress(), team());
}

}  // namespace freevoxels
