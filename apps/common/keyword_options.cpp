#include "apps/common/keyword_options.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/description/scene_json.h"
#include "engine/description/text_values.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

const std::vector<std::string> kDeviceKeys{"device", "memory-limit"};
/// Options of `freevoxels render` that are no fields of a scene.
const std::vector<std::string> kCommandLineKeys{"share", "sums", "color-parts", "out-dir", "format", "save-scene", "timings", "range"};
const std::vector<std::string> kSequenceKeys{"fixed-view", "skip-existing"};

/// The name of the field that a keyword means: "density-scale" for "density_scale".
std::string nameOf(std::string keyword) {
  std::ranges::replace(keyword, '_', '-');
  return keyword;
}

/// Whether a key and its value are a section of a scene, rather than a single light.
bool isSection(const std::string& key, const Json& value) {
  return value.is_object() && isSceneSection(key) && !value.contains("direction") && !value.contains("position");
}

class Reader {
 public:
  Reader(KeywordOptions& options, const KeywordOptions::Sections& sections) : options_(options), sections_(sections) {}

  void read(const Json& keywords);
  void readSceneFile();

 private:
  bool uses(const std::string& section) const { return std::ranges::find(sections_, section) != sections_.end(); }
  const SceneField& find(const std::string& section, const std::string& name) const;
  [[noreturn]] void refuse(const std::string& section, const std::string& name) const;
  bool giveOther(const std::string& name, const Json& value);
  void give(const SceneField& field, const Json& value, SceneFieldSet& given);

  KeywordOptions& options_;
  const KeywordOptions::Sections& sections_;
  SceneFieldSet stronger_;  ///< fields that are given
  std::string sceneFile_;
};

void Reader::refuse(const std::string& section, const std::string& name) const {
  if (section.empty() && std::ranges::find(kCommandLineKeys, name) != kCommandLineKeys.end())
    fail(ErrorKind::Usage, "{} is an option of the command line alone: leave it out", Parameter(name));
  if (section.empty() && std::ranges::find(kSequenceKeys, name) != kSequenceKeys.end())
    fail(ErrorKind::Usage, "{} is an option of sequences: leave it out", Parameter(name));
  std::vector<std::string> known;
  for (const SceneField& field : sceneFields()) {
    if (uses(field.section)) known.push_back(field.name);
    if (section.empty() && field.name == name) fail(ErrorKind::Usage, "{} has no effect here: leave it out", Parameter(name));
  }
  if (uses("device")) known.insert(known.end(), kDeviceKeys.begin(), kDeviceKeys.end());
  if (section.empty() && isSceneSection(name))
    fail(ErrorKind::Usage, "{} is a group of options, and takes a dictionary of them", Parameter(name));
  const std::string given = quotedPart(section.empty() ? name : section + "." + name);
  if (section == "light" && nearestName(name, known).empty())
    fail(ErrorKind::Usage, "there is no option {}; a single {} has a {} or a {}", Parameter(given), Parameter(section),
         Parameter("direction"), Parameter("position"));
  if (const std::string meant = nearestName(name, known); !meant.empty())
    fail(ErrorKind::Usage, "there is no option {}; did you mean {}?", Parameter(given), Parameter(meant));
  fail(ErrorKind::Usage, "there is no option {}; 'freevoxels render --help' lists them", Parameter(given));
}

const SceneField& Reader::find(const std::string& section, const std::string& name) const {
  for (const SceneField& field : sceneFields())
    if (uses(field.section) && (section.empty() || field.section == section) && (name == field.name || name == field.key())) return field;
  refuse(section, name);
}

/// Gives a key that is no field of a scene; false where it is one. What a stronger object gives stays.
bool Reader::giveOther(const std::string& name, const Json& value) {
  const bool isDevice = std::ranges::find(kDeviceKeys, name) != kDeviceKeys.end();
  if (!isDevice && name != "scene") return false;
  if (!uses(isDevice ? "device" : "scene")) fail(ErrorKind::Usage, "{} has no effect here: leave it out", Parameter(name));
  const std::string text = value.is_string() ? value.get<std::string>() : inQuotes(value);
  if (name == "scene" && sceneFile_.empty()) sceneFile_ = text;
  if (name == "device" && !options_.device.selector) options_.device.selector = text;
  if (name == "memory-limit" && !options_.device.memoryLimit) {
    const NumberForm form{
        .name = fmt::format("{}", Parameter(name)), .form = "MIB", .range = {1.0, double(std::numeric_limits<int>::max())}, .whole = true};
    options_.device.memoryLimit = int(readNumbers(form, text)[0]);
  }
  return true;
}

void Reader::give(const SceneField& field, const Json& value, SceneFieldSet& given) {
  const bool wantsList = field.repeated && !value.is_array();
  const auto texts = fieldTexts(field, wantsList ? Json::array({value}) : value, "", fmt::format("{}", Parameter(field.name)));
  if (texts.empty()) return;
  if (given.contains(&field))
    fail(ErrorKind::Usage, "{} is given twice, by two spellings of its name: keep one of them", Parameter(field.name));
  for (const SceneField* other : given)
    if (other != &field && field.isOrExcludes(*other))
      fail(ErrorKind::Usage, "{} and {} exclude each other: keep one of them", Parameter(field.name), Parameter(other->name));
  given.insert(&field);
  SceneDescription checked;
  field.read(isReplaced(field, stronger_) ? checked : options_.scene, texts);
}

void Reader::read(const Json& keywords) {
  SceneFieldSet given;
  for (const auto& [key, value] : keywords.items())
    if (const std::string name = nameOf(key); !isSection(key, value) && !giveOther(name, value)) give(find("", name), value, given);
  stronger_.merge(given);
  given.clear();
  for (const auto& [section, fields] : keywords.items()) {
    if (!isSection(section, fields) || !uses(section)) continue;
    for (const auto& [key, value] : fields.items()) give(find(section, nameOf(key)), value, given);
  }
  stronger_.merge(given);
}

void Reader::readSceneFile() {
  if (sceneFile_.empty()) return;
  const SceneFile scene(sceneFile_);
  options_.warnings = scene.warnings();
  scene.applyTo(options_.scene, [this](const SceneField& field) { return uses(field.section) && !isReplaced(field, stronger_); });
}

}  // namespace

KeywordOptions::KeywordOptions(const std::vector<Json>& layers, const Sections& sections) {
  Reader reader(*this, sections);
  for (const Json& layer : layers) reader.read(layer);
  reader.readSceneFile();
  if (device.memoryLimit) scene.input.memoryBytes = device.memoryBytes();
  try {
    std::ranges::move(functionWarnings(scene), std::back_inserter(warnings));
  } catch (const Error&) {
    // Whoever draws with the function fails with the same sentence.
  }
}

KeywordOptions::Sections KeywordOptions::sections(bool ofFile, bool choosesDevice) {
  Sections names{"volumes", "classification", "emission", "camera", "light", "method", "scene"};
  if (ofFile) names.emplace_back("input");
  if (choosesDevice) names.emplace_back("device");
  return names;
}

std::optional<Json> takeKey(Json& keywords, const std::string& name) {
  for (const auto& [key, value] : keywords.items()) {
    if (nameOf(key) != name) continue;
    Json taken = value;
    keywords.erase(key);
    return taken;
  }
  return std::nullopt;
}

}  // namespace freevoxels
