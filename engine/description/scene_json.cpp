#include "engine/description/scene_json.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/description/added_volume.h"
#include "engine/description/label_words.h"
#include "engine/description/text_values.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;
using Kind = SceneField::Kind;

std::string quoted(const std::string& section, const std::string& key) {
  return inShort(section.empty() ? key : section + "." + key);
}

std::string quoted(const SceneField& field) {
  return quoted(field.section, field.key());
}

char separatorOf(const SceneField& field) {
  return field.form.starts_with("WxH") ? 'x' : field.form.starts_with("AXIS:") ? ':' : ',';
}

/// Whether the text is not a file name: a procedural volume, or JSON.
bool isNoPath(const std::string& text) {
  return proceduralName(text) || isInlineJson(text) || isInMemory(text);
}

/// The name of a file of this field, as a scene in `folder` has it.
std::string namedFrom(const fs::path& folder, bool isFunction, const std::string& text) {
  if (isNoPath(text)) return text;
  return isFunction ? transferNameIn(folder.string(), text) : (folder / text).lexically_normal().string();
}

/// The same name as a scene in `folder` is to have it.
std::string namedFor(const fs::path& folder, bool isFunction, const std::string& text) {
  std::error_code error;
  if (isNoPath(text) || (isFunction && presetNamed(text) != nullptr && !fs::is_regular_file(text, error))) return text;
  return fs::proximate(text, folder).string();
}

std::string numbersText(const SceneField& field, const Json& list) {
  std::vector<std::string> words;
  for (const Json& value : list) words.push_back(value.is_number() ? value.dump() : value.is_string() ? value.get<std::string>() : "");
  return fmt::format("{}", fmt::join(words, std::string(1, separatorOf(field))));
}

bool isNumbers(const Json& list) {
  return list.is_array() && !list.empty() && std::ranges::all_of(list, [](const Json& v) { return v.is_number(); });
}

/// Whether a list is a word and what belongs to it, as ["z", 12.5].
bool isPair(const SceneField& field, const Json& list) {
  return separatorOf(field) == ':' && list.is_array() && list.size() == 2 && list[0].is_string() &&
         (list[1].is_number() || list[1].is_string());
}

/// The text "direction=1,0,0,intensity=3" for an object; empty if a value is neither a number nor a list.
std::string keysText(const SceneField& field, const Json& object) {
  std::vector<std::string> words;
  for (const auto& [key, value] : object.items()) {
    if (!value.is_number() && !isNumbers(value)) return "";
    words.push_back(key + "=" + (value.is_number() ? value.dump() : numbersText(field, value)));
  }
  return fmt::format("{}", fmt::join(words, ","));
}

std::string fieldText(const SceneField& field, const Json& value, const fs::path& folder, const std::string& name) {
  if (field.kind == Kind::Flag || field.kind == Kind::Switch) {
    if (value.is_boolean()) return value.dump();
    fail(ErrorKind::Input, "{} takes true or false, not {}", name, inShort(value));
  }
  if (field.kind == Kind::Volumes && (value.is_object() || value.is_string())) {
    const Json named = value.is_string() && !isInlineJson(value.get<std::string>()) ? Json{{"volume", value}} : value;
    if (named.is_string()) return named.get<std::string>();
    return withFiles(named, [&](const std::string& file, bool isFunction) { return namedFrom(folder, isFunction, file); })
        .dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    if (field.kind == Kind::Channel)
      return withFunction(name, text, [&](const std::string& file) { return namedFrom(folder, true, file); });
    return field.isFile() ? namedFrom(folder, field.kind == Kind::Function, text) : text;
  }
  if (!field.isFile() && value.is_number()) return value.dump();
  if (!field.isFile() && (isNumbers(value) || isPair(field, value))) return numbersText(field, value);
  if (value.is_object() && field.kind == Kind::Keys)
    if (const std::string text = keysText(field, value); !text.empty()) return text;
  if (value.is_object() && (field.kind == Kind::Function || field.kind == Kind::InlineJson))
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
  fail(ErrorKind::Input, "{} takes {}, not {}", name, field.form, inShort(value));
}

/// A number, a list of numbers, or the text if it is neither.
Json numbersOrText(const std::string& text, char separator) {
  Json list = Json::array();
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    list.push_back(parseJsonQuietly(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  if (!isNumbers(list)) return text;
  return list.size() == 1 ? list.front() : list;
}

bool isUnicode(const Json& value) {
  try {
    (void)value.dump();
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

/// Formats objects of two levels and lists of objects over several lines, other values on one line.
std::string layOut(const OrderedJson& value, int depth = 0) {
  const bool list = value.is_array() && !value.empty() && value.front().is_object();
  if (!list && (!value.is_object() || depth > 1)) return value.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  const std::string indent(std::size_t(2 * depth + 2), ' ');
  std::vector<std::string> lines;
  for (const auto& [key, entry] : value.items())
    lines.push_back(indent + (list ? "" : inQuotes(key) + ": ") + layOut(entry, depth + 1));
  return fmt::format("{}\n{}\n{}{}", list ? "[" : "{", fmt::join(lines, ",\n"), indent.substr(2), list ? "]" : "}");
}

/// Whether the value is a word of earlier versions for what need not be given: "auto" was the default, "exact" is what gathering does.
bool isFormerDefault(const SceneField& field, const Json& value) {
  return (field.name == "draw" && value == "auto") || (field.name == "attenuation" && (value == "auto" || value == "exact"));
}

/// Whether a list stands for the one field of a section: "volumes": [...].
bool isListOf(const std::string& section, const Json& value) {
  return value.is_array() && std::ranges::any_of(sceneFields(), [&](const SceneField& field) {
           return field.repeated && field.section == section && field.key() == section;
         });
}

/// The keys of a section with their values.
Json keysOf(const std::string& section, const Json& fields) {
  return isListOf(section, fields) ? Json{{section, fields}} : fields;
}

/// Whether the key is one of earlier versions that has no effect any more.
bool isFormerKey(const std::string& section, const std::string& key) {
  return section == "light" && key == "scattering-scale";
}

}  // namespace

OrderedJson fieldJson(const SceneField& field, const std::string& text, const std::optional<fs::path>& folder) {
  if (field.kind == Kind::Volumes)
    return withFiles(parseJson(field.name, "inline", text),
                     [&](const std::string& file, bool isFunction) { return folder ? namedFor(*folder, isFunction, file) : file; });
  if (field.kind == Kind::Flag || field.kind == Kind::Switch) return text == "true";
  if (text.empty()) return true;
  if (field.isFile()) {
    if (isInlineJson(text)) return parseJson(field.name, "inline", text);
    return folder ? namedFor(*folder, field.kind == Kind::Function, text) : text;
  }
  if (field.kind == Kind::Name) return text;
  if (field.kind == Kind::Channel && folder)
    return withFunction(field.name, text, [&](const std::string& file) { return namedFor(*folder, true, file); });
  if (field.kind != Kind::Keys) return numbersOrText(text, separatorOf(field));
  Json object = Json::object();
  for (const auto& [key, value] : readKeys(field.name, field.form, text)) object[key] = numbersOrText(value, ',');
  return object;
}

template <typename... Args>
void SceneFile::failHere(const std::string& format, Args&&... args) const {
  fail(ErrorKind::Input, "scene '{}': {}", file_.string(), fmt::format(fmt::runtime(format), std::forward<Args>(args)...));
}

SceneFile::SceneFile(const fs::path& file) : file_(file), root_(std::make_shared<const Json>(readJson("scene", file))) {
  if (!root_->is_object()) failHere("must be an object {{\"camera\": ...}}");
  for (const auto& [section, keys] : root_->items()) {
    if (!isSceneSection(section)) failUnknown("", section);
    if (!keys.is_object() && !isListOf(section, keys)) failHere("{} takes an object of keys, not {}", inShort(section), inShort(keys));
  }
}

void SceneFile::failUnknown(const std::string& section, const std::string& key) const {
  std::string nearest;
  std::size_t least = kFarName;
  const auto consider = [&](std::size_t distance, const std::string& name) {
    if (distance < least) least = distance, nearest = name;
  };
  for (const SceneField& field : sceneFields()) {
    if (section.empty()) consider(editDistance(key, field.section), inQuotes(field.section));
    consider(editDistance(key, field.key()) + (section == field.section ? 0 : 1), quoted(field));
  }
  failHere("there is no key {}{}", quoted(section, key),
           nearest.empty() ? "; apps/scenes/README.md has them all" : "; did you mean " + nearest + "?");
}

const SceneField& SceneFile::find(const std::string& section, const std::string& key) const {
  const auto found = std::ranges::find_if(
      sceneFields(), [&](const SceneField& field) { return field.section == section && field.key() == key; });
  if (found == sceneFields().end()) failUnknown(section, key);
  return *found;
}

bool SceneFile::hasVolume() const {
  return root_->contains("input") && root_->at("input").contains("volume");
}

void SceneFile::applyTo(SceneDescription& description, const std::function<bool(const SceneField&)>& wanted) const {
  std::vector<const SceneField*> given;
  for (const auto& [section, fields] : root_->items()) {
    const Json keys = keysOf(section, fields);
    for (const auto& [key, value] : keys.items()) {
      if (isFormerKey(section, key)) continue;
      const SceneField& field = find(section, key);
      if ((wanted && !wanted(field)) || isFormerDefault(field, value)) continue;
      const auto texts = fieldTexts(field, value, file_.parent_path(), fmt::format("scene '{}': {}", file_.string(), quoted(field)));
      if (!texts.empty()) try {
          field.read(description, texts);
        } catch (const Error& error) {
          failHere("{}", error.text());
        }
      for (const SceneField* other : given)
        if (field.isOrExcludes(*other)) failHere("{} and {} exclude each other: keep one of them", quoted(field), quoted(*other));
      given.push_back(&field);
    }
  }
}

std::vector<std::string> SceneFile::warnings() const {
  std::vector<std::string> result;
  for (const auto& [section, fields] : root_->items()) {
    const Json keys = keysOf(section, fields);
    for (const auto& [key, value] : keys.items())
      if (isFormerKey(section, key))
        result.push_back(fmt::format("scene '{}': {} is of an earlier version and has no effect: light is scattered as {} says",
                                     file_.string(), quoted(section, key), quoted("light", "scattering")));
  }
  return result;
}

SceneDescription readScene(const fs::path& file) {
  SceneDescription description;
  SceneFile(file).applyTo(description);
  return description;
}

OrderedJson sceneToJson(const SceneDescription& description, const std::optional<fs::path>& folder) {
  OrderedJson scene = OrderedJson::object();
  for (const SceneField& field : sceneFields())
    for (const std::string& text : field.texts(description)) {
      OrderedJson& place = field.repeated && field.key() == field.section ? scene[field.section] : scene[field.section][field.key()];
      if (field.repeated)
        place.push_back(OrderedJson(fieldJson(field, text, folder)));
      else
        place = fieldJson(field, text, folder);
    }
  return scene;
}

void writeScene(const fs::path& file, const SceneDescription& description) {
  const fs::path folder = fs::absolute(file).parent_path();
  for (const SceneField& field : sceneFields())
    for (const std::string& text : field.texts(description))
      if (!isUnicode(fieldJson(field, text, folder)))
        fail(ErrorKind::Input, "a scene file is Unicode text, and the {} '{}' is not: give that file or grid another name", field.name, printable(text));
  writeTextAtomically(file, layOut(sceneToJson(description, folder)) + "\n");
}

std::vector<std::string> fieldTexts(const SceneField& field, const Json& value, const fs::path& folder, const std::string& name) {
  if (field.standsAlone && value.is_boolean()) return {value.get<bool>() ? "" : kNone};
  if (!field.repeated) return {fieldText(field, value, folder, name)};
  if (!value.is_array()) fail(ErrorKind::Input, "{} takes a list, not {}", name, inShort(value));
  std::vector<std::string> texts;
  for (const Json& one : value) texts.push_back(fieldText(field, one, folder, name));
  return texts;
}

}  // namespace freevoxels
