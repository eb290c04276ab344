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

/// The keyword of an option: "density_scale" for --density-scale.
std::string keywordOf(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

std::string keywordOf(const CLI::Option& option) {
  return keywordOf(option.get_lnames().front());
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
      give("", keywordOf(key), value);
      continue;
    }
    for (const auto& [inner, one] : value.items()) give(key, keywordOf(inner), one);
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

CLI::Option* KeywordOptions::find(const std::string& section, const std::string& keyword) {
  std::vector<std::string> known;
  for (CLI::Option* option : app_.get_options([](const CLI::Option*) { return true; })) {
    if (option->get_lnames().empty() || !isSection(groupOf(*option))) continue;
    known.push_back(keywordOf(*option));
    if (!section.empty() && groupOf(*option) != section) continue;
    if (keyword == known.back() || keyword == keywordOf(sceneKey(*option))) return option;
  }
  const std::string meant = suggestion(keyword, known);
  fail(ExitCode::Usage, "there is no option '{}{}'{}", section.empty() ? "" : section + ".", keyword,
       meant.empty() ? "; 'freevoxels render --help' lists them, with - in place of _" : meant);
}

void KeywordOptions::give(const std::string& section, const std::string& keyword, const Json& value) {
  CLI::Option* const option = find(section, keyword);
  const bool wantsList = isRepeated(*option) && !value.is_array();
  const std::vector<std::string> texts = optionTexts(*option, wantsList ? Json::array({value}) : value, "", keyword);
  if (texts.empty()) return;
  for (const CLI::Option* other : given_)
    if (option->get_excludes().contains(const_cast<CLI::Option*>(other)))
      fail(ExitCode::Usage, "'{}' and '{}' exclude each other: keep one of them", keyword, keywordOf(*other));
  for (const std::string& text : texts) option->add_result(text);
  option->run_callback();
  given_.push_back(option);
}

}  // namespace freevoxels
