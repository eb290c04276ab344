#include "apps/common/bake.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/common/program.h"
#include "apps/common/scene_options.h"
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

/// Whether a file says with which value of the field it was baked.
bool isBaked(const SceneField& field) {
  return field.section == "classification" || field.section == "emission" || field.name == "volume" || field.name == "resolution" ||
         field.name == "grid" || field.name == "raw" || field.name == "series" || field.name == "time-step" || field.name == "spacing" ||
         field.name == "pyramid-level";
}

/// A pointer to a volume that somebody else owns.
std::shared_ptr<const Volume> borrowed(const Volume& volume) {
  return {std::shared_ptr<const Volume>(), &volume};
}

class Baker {
 public:
  Baker(const BakeRequest& request, const BakeRemarks& remarks, const Progress& progress)
      : request_(request), scene_(request.scene), remarks_(remarks), progress_(progress) {}

  void bake(const Volume& volume) const;
  void bakeProcedural(const std::string& name) const;
  /// Does nothing and returns false where the file's volume fits into memory, or cannot be read in parts.
  bool bakeParts() const;

 private:
  void bakeStream(const StreamedVolume& stream, const Volume& sample, const Classification& classification) const;
  BakeSettings settings(const Volume& volume, const Classification& classification) const;
  void agree(const std::string& content, const BakeSettings& settings) const;
  BakeTeam team() const;

  const BakeRequest& request_;
  const SceneDescription& scene_;
  const BakeRemarks& remarks_;
  const Progress& progress_;
};

/// Options of the file, for a volume with this classification.
BakeSettings Baker::settings(const Volume& volume, const Classification& classification) const {
  const Scene scene{.volume = borrowed(volume), .classification = classification};
  nlohmann::ordered_json json{{"program", "freevoxels " + programVersion()}, {"volume", volume.source}};
  for (const auto& [name, value] : optionMap(optionsOf(scene_.resolved(scene), isBaked))) json["options"][name] = value;
  if (const std::string& file = scene_.input.volume; std::filesystem::is_regular_file(file)) {
    json["file_bytes"] = std::filesystem::file_size(file);
    json["file_xxh3_64"] = fmt::format("{:016x}", fvx::hashOfFile(file));
  }
  return {.keepScalars = request_.keepScalars,
          .compress = request_.compress,
          .provenance = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)};
}

/// Fails where the processes of the group would not bake the same file.
void Baker::agree(const std::string& content, const BakeSettings& settings) const {
  request_.group->agree("another version of the program", programVersion());
  request_.group->agree("another volume or transfer function", content);
  nlohmann::json provenance = nlohmann::json::parse(settings.provenance);
  provenance.erase("volume");  // the volume's own name may differ from machine to machine
  provenance["options"].erase("input");
  request_.group->agree("other options", fmt::format("{} {} {}", settings.keepScalars, settings.compress, provenance.dump()));
}

BakeTeam Baker::team() const {
  ShareGroup* const group = request_.group;
  if (group == nullptr) return {};
  const SharePart place = group->place();
  return {.index = place.index, .count = place.count, .bring = [group](std::vector<std::byte>& bytes, int from) { group->bring(bytes, from); }};
}

void Baker::bake(const Volume& volume) const {
  if (volume.classificationIsFixed)
    fail(ErrorKind::Usage, "'{}' was baked for one classification: bake the volume that it was made of, or bake it with {}",
         scene_.input.volume.empty() ? volume.source : scene_.input.volume, Parameter("keep-scalars"));
  const Classification classification = scene_.resolveClassification(volume);
  if (remarks_) remarks_({.volume = borrowed(volume), .classification = classification});
  const BakeSettings chosen = settings(volume, classification);
  if (request_.group != nullptr) agree(contentHash(volume, classification, nullptr), chosen);
  bakeVolume(request_.file, volume, classification, chosen, progress_, team());
}

void Baker::bakeProcedural(const std::string& name) const {
  const ProceduralField field(name, *scene_.input.resolution);
  const glm::ivec3 size = field.dimensions();
  const int factor = (std::max({size.x, size.y, size.z}) + kSampleEdge - 1) / kSampleEdge;
  Volume sample = makeProcedural(name, glm::max(size / factor, 1));
  if (!scene_.emission.grid()) sample.temperature.reset();
  const Classification classification = scene_.resolveClassification(sample);
  bakeStream(proceduralStream(field, sample, classification), sample, classification);
}

bool Baker::bakeParts() const {
  if (scene_.input.kind() != VolumeKind::OpenVdb || !scene_.classification.channels.empty()) return false;
  const std::unique_ptr<const VdbParts> parts =
      VdbParts::open(scene_.input.volume,
                     {.grid = scene_.input.grid.value_or(""),
                      .more = {.temperature = scene_.emission.grid(), .albedo = scene_.classification.grid()},
                      .noData = scene_.input.noData,
                      .labels = scene_.classification.labelRequest()},
                     kMaxBytesInMemory);
  if (!parts) return false;
  const Classification classification = scene_.resolveClassification(parts->sample());
  if (remarks_) remarks_({.volume = borrowed(parts->sample()), .classification = classification});
  bakeStream(partsStream(*parts, classification), parts->sample(), classification);
  return true;
}

void Baker::bakeStream(const StreamedVolume& stream, const Volume& sample, const Classification& classification) const {
  const BakeSettings chosen = settings(sample, classification);
  if (request_.group != nullptr) agree(contentHash(sample, classification, nullptr), chosen);
  bakeStreamed(request_.file, stream, classification, chosen, progress_, team());
}

}  // namespace

void checkBake(const BakeRequest& request) {
  const std::string& file = request.file;
  if (std::filesystem::path(file).extension() != ".fvx")
    fail(ErrorKind::Usage, "'{}' is not named .fvx, and bake writes baked volumes; name it so", file);
  const InputDescription& input = request.scene.input;
  for (const auto& [isGiven, name] : {std::pair(input.clipBox.has_value(), "clip-box"), std::pair(input.clipPlane.has_value(), "clip-plane")})
    if (isGiven) fail(ErrorKind::Usage, "{} has no effect here, as the whole volume is baked: leave it out", Parameter(name));
  request.scene.check();
  if (request.group == nullptr || request.group->leads()) checkOutput(file);
  if (!input.volume.empty() && !proceduralName(input.volume)) checkDistinct({input.volume, file});
}

void bakeScene(const BakeRequest& request, const BakeRemarks& remarks, const Progress& progress) {
  const InputDescription& input = request.scene.input;
  const Baker baker(request, remarks, progress);
  const std::optional<std::string> name = proceduralName(input.volume);
  const glm::u64vec3 size(input.resolution.value_or(glm::ivec3(kDefaultResolution)));
  if (name && !input.noData && size.x * size.y * size.z > kMaxVoxelsInMemory)
    baker.bakeProcedural(*name);
  else if (name || !baker.bakeParts())
    baker.bake(request.scene.readVolume(machineMemoryBytes() / sizeof(float), 0, progress));
}

void bakeInMemory(const BakeRequest& request, const Volume& volume, const Progress& progress) {
  Baker(request, {}, progress).bake(volume);
}

}  // namespace freevoxels
