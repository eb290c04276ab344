#include "apps/library/keyword_options.h"

#include <algorithm>

#include "apps/freevoxels/scene_value.h"
#include "engine/core/error.h"
#include "engine/core/nearest_name.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

std::string groupOf(const CLI::Option& option) {
  return CLI::detail::to_lower(option.get_group());
}

/// The name of the option that a keyword means: "density-scale" for "density_scale".
std::string nameOf(std::string keyword) {
  std::ranges::replace(keyword, '_', '-');
  return keyword;
}

std::string nameOf(const CLI::Option& option) {
  return option.get_lnames().front();
}

/// Whether a value of the key "light" is a single light, rather than the section of that name.
bool isLight(const Json& value) {
  return value.contains("direction") || value.contains("position");
}

}  // namespace

KeywordOptions::KeywordOptions(const Json& keywords, std::vector<std::string> sections, const std::string& volume)
    : sections_(std::move(sections)) {
  scene.add(app_);
  scene.lighting.addMethod(app_);
  method.add(app_);
  device.add(app_);
  for (const auto& [key, value] : keywords.items()) {
    if (!value.is_object() || !isSection(key) || isLight(value)) {
      give("", nameOf(key), value);
      continue;
    }
    for (const auto& [inner, one] : value.items()) give(key, nameOf(inner), one);
  }
  if (!volume.empty()) {
    app_.get_option("IN")->add_result(volume);
    app_.get_option("IN")->run_callback();
  }
  scene.file.apply([this](const std::string& option) { return scene.output.honours(option); });
  for (const CLI::Option* option : app_.get_options())
    if (groupOf(*option) == "classification" || groupOf(*option) == "emission")
      for (const std::string& text : option->results()) classificationText_ += fmt::format("{}={} ", optionName(*option), text);
}

bool KeywordOptions::isSection(const std::string& name) const {
  return std::ranges::find(sections_, name) != sections_.end();
}

CLI::Option* KeywordOptions::find(const std::string& section, const std::string& name) {
  std::vector<std::string> known;
  for (CLI::Option* option : app_.get_options([](const CLI::Option*) { return true; })) {
    if (option->get_lnames().empty()) continue;
    if (!isSection(groupOf(*option))) {
      if (name == nameOf(*option)) fail(ErrorKind::Usage, "{} has no effect here: leave it out", Parameter(name));
      continue;
    }
    known.push_back(nameOf(*option));
    if (!section.empty() && groupOf(*option) != section) continue;
    if (name == known.back() || name == sceneKey(*option)) return option;
  }
  const std::string given = section.empty() ? name : section + "." + name;
  if (const std::string meant = nearestName(name, known); !meant.empty())
    fail(ErrorKind::Usage, "there is no option {}; did you mean {}?", Parameter(given), Parameter(meant));
  fail(ErrorKind::Usage, "there is no option {}; 'freevoxels render --help' lists them", Parameter(given));
}

void KeywordOptions::give(const std::string& section, const std::string& name, const Json& value) {
  CLI::Option* const option = find(section, name);
  const bool wantsList = isRepeated(*option) && !value.is_array();
  const std::vector<std::string> texts = optionTexts(*option, wantsList ? Json::array({value}) : value, "", fmt::format("{}", Parameter(name)));
  if (texts.empty()) return;
  for (const CLI::Option* other : given_)
    if (option->get_excludes().contains(const_cast<CLI::Option*>(other)))
      fail(ErrorKind::Usage, "{} and {} exclude each other: keep one of them", Parameter(name), Parameter(nameOf(*other)));
  for (const std::string& text : texts) option->add_result(text);
  option->run_callback();
  given_.push_back(option);
}

const KeywordOptions& KeywordOptions::all() {
  static const KeywordOptions options(Json::object(), {});
  return options;
}

std::string KeywordOptions::marked(std::string_view text) const {
  constexpr std::string_view kOfNames = "abcdefghijklmnopqrstuvwxyz-";
  std::string result;
  while (!text.empty()) {
    const std::size_t begin = std::min(text.find("--"), text.size());
    result += text.substr(0, begin);
    text.remove_prefix(begin);
    const std::string name(text.substr(0, std::min(text.find_first_not_of(kOfNames), text.size())));
    const CLI::Option* const option = name.size() > 2 ? app_.get_option_no_throw(name) : nullptr;
    text.remove_prefix(name.size());
    if (option == nullptr) {
      result += name;
      continue;
    }
    std::string_view value;
    for (const std::string& word : CLI::detail::split(option->get_type_name(), '|'))
      if (text.starts_with(" " + word) && text.find_first_of(kOfNames, word.size() + 1) != word.size() + 1) value = text.substr(1, word.size());
    if (!value.empty()) text.remove_prefix(value.size() + 1);
    result += fmt::format("{}", Parameter(std::string_view(name).substr(2), value));
  }
  return result;
}

}  // namespace freevoxels
