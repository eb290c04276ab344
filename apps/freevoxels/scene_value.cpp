#include "apps/freevoxels/scene_value.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/freevoxels/input_options.h"
#include "apps/freevoxels/option_values.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Groups of --help that say how a command runs, not what its images show.
constexpr std::array<std::string_view, 7> kOfTheRun{"Options", "Scene", "Device", "Messages", "Window", "Sequence", "Cluster"};

bool isFlag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

/// Whether the option may be given without a value.
bool standsAlone(const CLI::Option& option) {
  return !isFlag(option) && option.get_items_expected_min() == 0;
}

bool isFile(const CLI::Option& option) {
  return option.get_positional() || option.get_type_name().starts_with("FILE");
}

/// Whether the option's text is a name, whatever it looks like.
bool isName(const CLI::Option& option) {
  return isFile(option) || option.get_type_name() == "NAME";
}

bool hasKeys(const CLI::Option& option) {
  return option.get_type_name().find('=') != std::string::npos;
}

char separatorOf(const CLI::Option& option) {
  return option.get_type_name().starts_with("WxH") ? 'x' : ',';
}

/// Whether the text is not a file name: a procedural volume, or JSON.
bool isNoPath(const std::string& text) {
  return proceduralName(text) || isInlineJson(text);
}

std::string numbersText(const CLI::Option& option, const Json& list) {
  std::vector<std::string> words;
  for (const Json& value : list) words.push_back(value.is_number() ? value.dump() : "");
  return fmt::format("{}", fmt::join(words, std::string(1, separatorOf(option))));
}

bool isNumbers(const Json& list) {
  return list.is_array() && !list.empty() &&
         std::ranges::all_of(list, [](const Json& v) { return v.is_number(); });
}

/// The text "direction=1,0,0,intensity=3" for an object; empty if a value is neither a number nor a list.
std::string keysText(const CLI::Option& option, const Json& object) {
  std::vector<std::string> words;
  for (const auto& [key, value] : object.items()) {
    if (!value.is_number() && !isNumbers(value)) return "";
    words.push_back(key + "=" + (value.is_number() ? value.dump() : numbersText(option, value)));
  }
  return fmt::format("{}", fmt::join(words, ","));
}

std::string optionText(const CLI::Option& option, const Json& value, const fs::path& folder,
                       const std::string& name) {
  if (isFlag(option)) {
    if (value.is_boolean()) return value.dump();
    fail(ErrorKind::Input, "{} takes true or false, not {}", name, inQuotes(value));
  }
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    return isFile(option) && !isNoPath(text) ? (folder / text).lexically_normal().string() : text;
  }
  if (!isFile(option) && value.is_number()) return value.dump();
  if (!isFile(option) && isNumbers(value)) return numbersText(option, value);
  if (value.is_object() && hasKeys(option))
    if (const std::string text = keysText(option, value); !text.empty()) return text;
  if (value.is_object() && isFile(option) && !option.get_positional()) return value.dump();
  fail(ErrorKind::Input, "{} takes {}, not {}", name,
       option.get_positional() ? "the name of a volume" : option.get_type_name(), inQuotes(value));
}

/// A number, a list of numbers, or the text if it is neither.
Json numbersOrText(const std::string& text, char separator) {
  Json list = Json::array();
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    list.push_back(Json::parse(text.substr(begin, end - begin), nullptr, false));
    begin = end + 1;
  }
  if (!isNumbers(list)) return text;
  return list.size() == 1 ? list.front() : list;
}

}  // namespace

std::string optionName(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true) : "--" + option.get_lnames().front();
}

bool isRepeated(const CLI::Option& option) {
  return option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll && !option.get_positional() &&
         !isFlag(option);
}

std::string sceneKey(const CLI::Option& option) {
  if (option.get_positional()) return "volume";
  return option.get_lnames().front() + (isRepeated(option) ? "s" : "");
}

std::string sceneSection(const CLI::Option& option) {
  const std::string& group = option.get_group();
  return std::ranges::find(kOfTheRun, group) == kOfTheRun.end() ? CLI::detail::to_lower(group) : "";
}

std::vector<std::string> optionTexts(const CLI::Option& option, const nlohmann::json& value,
                                     const fs::path& folder, const std::string& name) {
  if (standsAlone(option) && value.is_boolean())
    return value.get<bool>() ? std::vector<std::string>{""} : std::vector<std::string>{};
  if (!isRepeated(option)) return {optionText(option, value, folder, name)};
  if (!value.is_array()) fail(ErrorKind::Input, "{} takes a list, not {}", name, inQuotes(value));
  std::vector<std::string> texts;
  for (const Json& one : value) texts.push_back(optionText(option, one, folder, name));
  return texts;
}

nlohmann::json sceneValue(const CLI::Option& option, const std::string& text, const fs::path& folder) {
  if (text.empty()) return true;
  if (isFile(option) && isInlineJson(text)) return Json::parse(text);
  if (isFile(option) && !isNoPath(text)) return fs::proximate(text, folder).string();
  if (isName(option)) return text;
  if (!hasKeys(option)) return numbersOrText(text, separatorOf(option));
  Json object = Json::object();
  for (const auto& [key, value] : readKeys(optionName(option), option.get_type_name(), text))
    object[key] = numbersOrText(value, ',');
  return object;
}

}  // namespace freevoxels
