#include "apps/freevoxels/option_values.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

/// The expected form, for messages.
struct Expectation {
  std::string option, form;
  std::size_t count = 1;  ///< 0 for one number that may be left out
  NumberRange range;
  bool whole = false;
  bool mayBeOne = false;  ///< whether one number stands for `count` equal ones
  char separator = ',';
};

struct NamedColor {
  std::string_view name;
  std::uint32_t srgb;  ///< 0xRRGGBB
};
/// Basic colour names of CSS.
constexpr std::array<NamedColor, 12> kNamedColors{{{"black", 0x000000},
                                                   {"white", 0xffffff},
                                                   {"gray", 0x808080},
                                                   {"grey", 0x808080},
                                                   {"red", 0xff0000},
                                                   {"green", 0x008000},
                                                   {"blue", 0x0000ff},
                                                   {"yellow", 0xffff00},
                                                   {"orange", 0xffa500},
                                                   {"brown", 0xa52a2a},
                                                   {"cyan", 0x00ffff},
                                                   {"magenta", 0xff00ff}}};

std::string rangeText(const Expectation& expected) {
  const NumberRange range = expected.range;
  if (std::isfinite(range.minimum) && std::isfinite(range.maximum))
    return fmt::format(" from {} to {}", range.minimum, range.maximum);
  if (std::isfinite(range.minimum)) return fmt::format(" of at least {}", range.minimum);
  return "";
}

bool isColor(const Expectation& expected) {
  return expected.form.starts_with("R,G,B");
}

std::string colorSuggestion(const std::string& text) {
  std::vector<std::string> names;
  for (const NamedColor& color : kNamedColors) names.emplace_back(color.name);
  return suggestion(text, names);
}

[[noreturn]] void refuse(const Expectation& expected, const std::string& text) {
  const bool one = expected.count <= 1;
  fail(ErrorKind::Usage, "{} takes {}, {}{} number{}{}{}, not '{}'{}", expected.option, expected.form, one ? "a " : "",
       expected.whole ? "whole" : "finite", one ? "" : "s", rangeText(expected),
       isColor(expected) ? ", or a colour such as #ff8000 or white" : "", text, isColor(expected) ? colorSuggestion(text) : "");
}

std::optional<double> parseNumber(std::string_view word, const Expectation& expected) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [stopped, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  if (value < expected.range.minimum || value > expected.range.maximum) return std::nullopt;
  if (expected.whole && value != std::floor(value)) return std::nullopt;
  return value;
}

std::vector<double> parseNumbers(const std::string& text, const Expectation& expected) {
  if (isColor(expected))
    if (const std::optional<glm::dvec3> color = namedColor(text)) return {color->r, color->g, color->b};
  std::vector<double> values;
  if (expected.count == 0 && text.empty()) return values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(expected.separator, begin), text.size());
    const std::optional<double> value =
        parseNumber(std::string_view(text).substr(begin, end - begin), expected);
    if (!value) refuse(expected, text);
    values.push_back(*value);
    begin = end + 1;
  }
  if (expected.mayBeOne && values.size() == 1) values.resize(expected.count, values.front());
  if (values.size() != std::max<std::size_t>(expected.count, 1)) refuse(expected, text);
  return values;
}

template <typename Assign>
CLI::Option* addNumbers(CLI::App& app, const Expectation& expected, const std::string& description,
                        Assign assign) {
  return app
      .add_option_function<std::string>(
          expected.option,
          [expected, assign](const std::string& text) { assign(parseNumbers(text, expected)); }, description)
      ->take_last()
      ->type_name(expected.form);
}

}  // namespace

std::optional<glm::dvec3> namedColor(const std::string& text) {
  std::uint32_t srgb = 0;
  if (text.starts_with('#')) {
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data() + 1, end, srgb, 16);
    if (text.size() != 7 || error != std::errc() || stopped != end) return std::nullopt;
  } else {
    const auto named = std::ranges::find(kNamedColors, text, &NamedColor::name);
    if (named == kNamedColors.end()) return std::nullopt;
    srgb = named->srgb;
  }
  const auto linear = [srgb](int shift) { return double(linearFromSrgb(float((srgb >> shift) & 0xff) / 255.0f)); };
  return glm::dvec3(linear(16), linear(8), linear(0));
}

CLI::Option* addNumber(CLI::App& app, const std::string& name, const std::string& form,
                       std::optional<double>& target, const std::string& description, NumberRange range) {
  return addNumbers(app, {.option = name, .form = form, .range = range}, description,
                    [&target](const std::vector<double>& values) { target = values[0]; });
}

CLI::Option* addOptionalNumber(CLI::App& app, const std::string& name, const std::string& form, bool& given,
                               std::optional<double>& target, const std::string& description,
                               NumberRange range) {
  return addNumbers(app, {.option = name, .form = form, .count = 0, .range = range}, description,
                    [&](const std::vector<double>& values) {
                      given = true;
                      target = values.empty() ? std::nullopt : std::optional(values[0]);
                    })
      ->expected(0, 1);
}

CLI::Option* addPair(CLI::App& app, const std::string& name, const std::string& form,
                     std::optional<glm::dvec2>& target, const std::string& description, NumberRange range) {
  return addNumbers(
      app, {.option = name, .form = form, .count = 2, .range = range}, description,
      [&target](const std::vector<double>& values) { target = glm::dvec2(values[0], values[1]); });
}

CLI::Option* addTriple(CLI::App& app, const std::string& name, const std::string& form,
                       std::optional<glm::dvec3>& target, const std::string& description, NumberRange range) {
  return addNumbers(
      app, {.option = name, .form = form, .count = 3, .range = range}, description,
      [&target](const std::vector<double>& values) { target = glm::dvec3(values[0], values[1], values[2]); });
}

CLI::Option* addWholeNumber(CLI::App& app, const std::string& name, const std::string& form,
                            std::optional<int>& target, const std::string& description, NumberRange range) {
  return addNumbers(app, {.option = name, .form = form, .range = range, .whole = true}, description,
                    [&target](const std::vector<double>& values) { target = int(values[0]); });
}

CLI::Option* addSize(CLI::App& app, const std::string& name, glm::ivec2& target, int maximum,
                     const std::string& description) {
  return addNumbers(app,
                    {.option = name,
                     .form = "WxH",
                     .count = 2,
                     .range = {1.0, double(maximum)},
                     .whole = true,
                     .mayBeOne = true,
                     .separator = 'x'},
                    description, [&target](const std::vector<double>& values) {
                      target = glm::ivec2(values[0], values[1]);
                    });
}

CLI::Option* addDimensions(CLI::App& app, const std::string& name, std::optional<glm::ivec3>& target, int maximum,
                           const std::string& description) {
  return addNumbers(app,
                    {.option = name,
                     .form = "WxHxD",
                     .count = 3,
                     .range = {1.0, double(maximum)},
                     .whole = true,
                     .mayBeOne = true,
                     .separator = 'x'},
                    description, [&target](const std::vector<double>& values) {
                      target = glm::ivec3(values[0], values[1], values[2]);
                    });
}

CLI::Option* addText(CLI::App& app, const std::string& name, const std::string& form,
                     std::optional<std::string>& target, const std::string& description) {
  return app
      .add_option_function<std::string>(
          name, [&target](const std::string& text) { target = text; }, description)
      ->take_last()
      ->type_name(form);
}

std::vector<double> readNumbers(const std::string& name, const std::string& form, std::size_t count,
                                const std::string& text, NumberRange range) {
  return parseNumbers(text, {.option = name, .form = form, .count = count, .range = range});
}

std::map<std::string, std::string> readKeys(const std::string& name, const std::string& form,
                                            const std::string& text) {
  std::map<std::string, std::string> keys;
  std::string key;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) {
      if (key.empty()) fail(ErrorKind::Usage, "{} takes {}, not '{}'", name, form, text);
      keys[key] += "," + word;
      continue;
    }
    key = word.substr(0, equals);
    if (!keys.emplace(key, word.substr(equals + 1)).second)
      fail(ErrorKind::Usage, "{} '{}' gives '{}' twice: give it once", name, text, key);
  }
  return keys;
}

bool isInlineJson(const std::string& text) {
  return text.starts_with('{');
}

CLI::Option* addWord(CLI::App& app, const std::string& name, const std::vector<std::string>& words,
                     std::optional<int>& target, const std::string& description) {
  const auto read = [name, words, &target](const std::string& text) {
    const auto found = std::ranges::find(words, text);
    if (found == words.end())
      fail(ErrorKind::Usage, "{} takes '{}', not '{}'", name, fmt::join(words, "' or '"), text);
    target = int(found - words.begin());
  };
  return app.add_option_function<std::string>(name, read, description)
      ->take_last()
      ->type_name(fmt::format("{}", fmt::join(words, "|")));
}

std::string numberText(double value) {
  return fmt::format("{}", value);
}

std::string numberText(glm::dvec3 value) {
  return fmt::format("{},{},{}", value.x, value.y, value.z);
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
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
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
