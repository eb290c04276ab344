#include "engine/description/added_volume.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"
#include "engine/description/scene_fields.h"
#include "engine/description/scene_json.h"
#include "engine/description/text_values.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

constexpr const char* kVolume = "volume";
constexpr const char* kTransform = "transform";
constexpr const char* kForm = "FILE[,KEY=VALUE...]";
/// Numbers of a transform: of an offset; of the rows of a matrix of 3 x 4.
constexpr std::size_t kOffsetNumbers = 3, kMatrixNumbers = 12;

/// The fields that a volume has for itself.
std::vector<const SceneField*> ownFields() {
  std::vector<const SceneField*> own;
  for (const SceneField& field : sceneFields())
    if (field.section == "input" || field.section == "classification" || field.section == "emission" || field.name == "shading")
      own.push_back(&field);
  return own;
}

const SceneField& ownField(const std::string& key) {
  std::vector<std::string> names{kTransform};
  for (const SceneField* field : ownFields()) {
    if (field->name == key) return *field;
    names.push_back(field->name);
  }
  const std::string meant = nearestName(key, names);
  fail(ErrorKind::Usage, "{} knows no key '{}'{}", Parameter("add"), key, meant.empty() ? "" : "; did you mean '" + meant + "'?");
}

glm::dmat4 readTransform(const std::string& text) {
  const bool isOffset = std::ranges::count(text, ',') < std::ptrdiff_t(kOffsetNumbers);
  const auto n = readNumbers({.name = fmt::format("{} {}", Parameter("add"), kTransform),
                              .form = "an offset X,Y,Z or the 12 numbers of a matrix of 3 rows and 4 columns",
                              .count = isOffset ? kOffsetNumbers : kMatrixNumbers},
                             text);
  if (isOffset) {
    glm::dmat4 offset(1.0);
    offset[3] = {n[0], n[1], n[2], 1.0};
    return offset;
  }
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = n[std::size_t(4 * row + column)];
  if (!(std::abs(glm::determinant(glm::dmat3(matrix))) > 0.0))
    fail(ErrorKind::Usage, "{} {} flattens the volume: give a matrix that can be inverted", Parameter("add"), kTransform);
  return matrix;
}

/// What an added volume has, as a scene of its own.
SceneDescription sceneOf(const AddedVolume& added) {
  return {.input = added.input, .classification = added.classification, .emission = added.emission, .lighting = {.shading = added.shading}};
}

Json objectOf(const std::string& text) {
  if (isInlineJson(text)) {
    Json object = parseJsonQuietly(text);
    if (!object.is_object()) fail(ErrorKind::Usage, "{} is no JSON: '{}'", Parameter("add"), text);
    return object;
  }
  const std::size_t comma = std::min(text.find(','), text.size());
  Json object = {{kVolume, text.substr(0, comma)}};
  if (comma + 1 < text.size())
    for (const auto& [key, value] : readKeys(fmt::format("{}", Parameter("add")), kForm, text.substr(comma + 1))) object[key] = value;
  return object;
}

std::string joinedTexts(const Json& list, const std::function<std::string(const Json&)>& textOf) {
  std::vector<std::string> words;
  for (const Json& one : list) words.push_back(textOf(one));
  return fmt::format("{}", fmt::join(words, ","));
}

/// A transform's text for a list of numbers, or of such lists.
std::string transformNumbers(const Json& value) {
  const auto plain = [](const Json& one) { return one.dump(-1, ' ', false, Json::error_handler_t::replace); };
  const auto row = [&](const Json& one) { return one.is_array() ? joinedTexts(one, plain) : plain(one); };
  if (value.is_string()) return value.get<std::string>();
  return value.is_array() ? joinedTexts(value, row) : plain(value);
}

constexpr const char* kMemoryPrefix = "memory:";

/// The volumes in memory that have names, by these.
class NamedVolumes {
 public:
  std::string add(const std::shared_ptr<const Volume>& volume) {
    const std::lock_guard lock(mutex_);
    std::erase_if(volumes_, [](const auto& one) { return one.second.expired(); });
    for (const auto& [name, known] : volumes_)
      if (known.lock() == volume) return name;
    const std::string name = fmt::format("{}{}", kMemoryPrefix, next_++);
    volumes_[name] = volume;
    return name;
  }
  std::shared_ptr<const Volume> at(const std::string& name) {
    const std::lock_guard lock(mutex_);
    const auto found = volumes_.find(name);
    std::shared_ptr<const Volume> volume = found == volumes_.end() ? nullptr : found->second.lock();
    if (!volume) fail(ErrorKind::Usage, "there is no volume {} in memory any more: give the volume itself, or a file", name);
    return volume;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const Volume>> volumes_;
  std::uint64_t next_ = 1;
};

NamedVolumes& namedVolumes() {
  static NamedVolumes volumes;
  return volumes;
}

std::shared_ptr<const VolumeSource> readSource(const AddedVolume& added, const Progress& progress) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const VolumeSource>> known;
  AddedVolume file = added;  // what decides which grids are read is in the text, too
  const std::string text = addedVolumeText(file);
  const std::lock_guard lock(mutex);
  if (std::shared_ptr<const VolumeSource> there = known[text].lock()) return there;
  if (isInMemory(added.input.volume) && !added.transform)
    return std::make_shared<const VolumeInMemory>(namedVolumes().at(added.input.volume));
  Volume volume =
      isInMemory(added.input.volume) ? *namedVolumes().at(added.input.volume) : sceneOf(added).readVolume(kMaxNumberedVoxels, 0, progress);
  if (added.transform) volume.indexToWorld = *added.transform * volume.indexToWorld;
  auto source = std::make_shared<const VolumeInMemory>(std::make_shared<const Volume>(std::move(volume)));
  known[text] = source;
  return source;
}

}  // namespace

std::string nameInMemory(const std::shared_ptr<const Volume>& volume) {
  return namedVolumes().add(volume);
}

bool isInMemory(const std::string& text) {
  return text.starts_with(kMemoryPrefix);
}

std::vector<std::shared_ptr<const Volume>> volumesInMemory(const SceneDescription& scene) {
  std::vector<std::shared_ptr<const Volume>> volumes;
  for (const AddedVolume& added : scene.added)
    if (isInMemory(added.input.volume)) volumes.push_back(namedVolumes().at(added.input.volume));
  return volumes;
}

AddedVolume readAddedVolume(const std::string& text) {
  SceneDescription scene;
  AddedVolume added;
  const Json object = objectOf(text);
  for (const auto& [key, value] : object.items()) {
    std::string name = key;
    std::ranges::replace(name, '_', '-');
    if (name == kTransform) {
      added.transform = readTransform(transformNumbers(value));
      continue;
    }
    const SceneField& field = ownField(name);
    field.read(scene, fieldTexts(field, value, "", fmt::format("{} {}", Parameter("add"), name)));
  }
  if (scene.input.volume.empty())
    fail(ErrorKind::Usage, "{} '{}' names no volume: begin with a file, or give a {}", Parameter("add"), text, kVolume);
  added.input = scene.input;
  added.classification = scene.classification;
  added.emission = scene.emission;
  added.shading = scene.lighting.shading;
  return added;
}

std::string addedVolumeText(const AddedVolume& added) {
  const SceneDescription scene = sceneOf(added);
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const SceneField* field : ownFields())
    for (const std::string& text : field->texts(scene)) object[field->name] = fieldJson(*field, text, std::nullopt);
  if (added.transform) {
    object[kTransform] = nlohmann::ordered_json::array();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) object[kTransform].push_back((*added.transform)[column][row]);
  }
  return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Json withFiles(Json added, const std::function<std::string(const std::string&, bool)>& change) {
  if (added.is_string()) return change(added.get<std::string>(), false);
  if (!added.is_object()) return added;
  for (const auto& [key, value] : added.items()) {
    const bool isFunction = key == "transfer-function" || key == "transfer_function";
    if (value.is_string() && (key == kVolume || isFunction)) value = change(value.get<std::string>(), isFunction);
  }
  return added;
}

std::vector<SceneVolume> openAddedVolumes(const SceneDescription& scene, const Progress& progress) {
  std::vector<SceneVolume> volumes;
  for (const AddedVolume& added : scene.added) {
    SceneVolume opened{.source = readSource(added, progress), .classification = {}};
    const Volume& volume = *known(opened.source);
    opened.classification = sceneOf(added).resolveClassification(volume);
    LightingDescription lighting = scene.lighting;
    if (added.shading) lighting.shading = added.shading;
    opened.surface = lighting.surfaceOf(volume, opened.classification);
    volumes.push_back(std::move(opened));
  }
  return volumes;
}

}  // namespace freevoxels
