#include "apps/common/option_values.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

namespace freevoxels {

namespace {

template <typename Assign>
CLI::Option* addNumbers(CLI::App& app, const NumberForm& expected, const std::string& description, Assign assign) {
  return app
      .add_option_function<std::string>(
          expected.name, [expected, assign](const std::string& text) { assign(readNumbers(expected, text)); }, description)
      ->take_last()
      ->type_name(expected.form);
}

}  // namespace

CLI::Option* addNumber(CLI::App& app, const std::string& name, const std::string& form, std::optional<double>& target,
                       const std::string& description, NumberRange range) {
  return addNumbers(app, {.name = name, .form = form, .range = range}, description,
                    [&target](const std::vector<double>& values) { target = values[0]; });
}

CLI::Option* addPair(CLI::App& app, const std::string& name, const std::string& form, std::optional<glm::dvec2>& target,
                     const std::string& description, NumberRange range) {
  return addNumbers(app, {.name = name, .form = form, .count = 2, .range = range}, description,
                    [&target](const std::vector<double>& values) { target = glm::dvec2(values[0], values[1]); });
}

CLI::Option* addTriple(CLI::App& app, const std::string& name, const std::string& form, std::optional<glm::dvec3>& target,
                       const std::string& description, NumberRange range) {
  return addNumbers(app, {.name = name, .form = form, .count = 3, .range = range}, description,
                    [&target](const std::vector<double>& values) { target = glm::dvec3(values[0], values[1], values[2]); });
}

CLI::Option* addWholeNumber(CLI::App& app, const std::string& name, const std::string& form, std::optional<int>& target,
                            const std::string& description, NumberRange range) {
  return addNumbers(app, {.name = name, .form = form, .range = range, .whole = true}, description,
                    [&target](const std::vector<double>& values) { target = int(values[0]); });
}

CLI::Option* addText(CLI::App& app, const std::string& name, const std::string& form, std::optional<std::string>& target,
                     const std::string& description) {
  return app
      .add_option_function<std::string>(
          name, [&target](const std::string& text) { target = text; }, description)
      ->take_last()
      ->type_name(form);
}

std::map<std::string, std::string> optionMap(const OptionList& options) {
  std::map<std::string, std::string> map;
  for (const auto& [name, value] : options) {
    const std::string key = name.empty() ? "input" : name.substr(name.find_first_not_of('-'));
    const std::string text = value.empty() ? "yes" : value;
    const auto [place, isNew] = map.emplace(key, text);
    if (!isNew) place->second += " " + text;
  }
  return map;
}

std::string commandText(const OptionList& options) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  std::vector<std::string> words;
  const auto addQuoted = [&](const std::string& word) {
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      words.push_back(word);
      return;
    }
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    words.push_back(quoted + "'");
  };
  for (const auto& [name, value] : options) {
    if (!name.empty()) words.push_back(name);
    if (!value.empty()) addQuoted(value);
  }
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace freevoxels
