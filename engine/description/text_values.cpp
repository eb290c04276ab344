#include "engine/description/text_values.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

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

std::string rangeText(const NumberForm& expected) {
  const NumberRange range = expected.range;
  if (std::isfinite(range.minimum) && std::isfinite(range.maximum))
    return fmt::format(" from {} to {}", range.minimum, range.maximum);
  if (std::isfinite(range.minimum)) return fmt::format(" of at least {}", range.minimum);
  return "";
}

bool isColor(const NumberForm& expected) {
  return expected.form.starts_with("R,G,B");
}

std::string colorSuggestion(const std::string& text) {
  std::vector<std::string> names;
  for (const NamedColor& color : kNamedColors) names.emplace_back(color.name);
  return suggestion(text, names);
}

[[noreturn]] void refuse(const NumberForm& expected, const std::string& text) {
  const bool one = expected.count <= 1;
  fail(ErrorKind::Usage, "{} takes {}, {}{} number{}{}{}, not '{}'{}", expected.name, expected.form, one ? "a " : "",
       expected.whole ? "whole" : "finite", one ? "" : "s", rangeText(expected),
       isColor(expected) ? ", or a colour such as #ff8000 or white" : "", quotedPart(text), isColor(expected) ? colorSuggestion(text) : "");
}

std::optional<double> parseNumber(std::string_view word, const NumberForm& expected) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [stopped, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  if (value < expected.range.minimum || value > expected.range.maximum) return std::nullopt;
  if (expected.whole && value != std::floor(value)) return std::nullopt;
  return value;
}

}  // namespace

std::vector<double> readNumbers(const NumberForm& expected, const std::string& text) {
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
      if (key.empty()) fail(ErrorKind::Usage, "{} takes {}, not '{}'", name, form, quotedPart(text));
      keys[key] += "," + word;
      continue;
    }
    key = word.substr(0, equals);
    if (!keys.emplace(key, word.substr(equals + 1)).second)
      fail(ErrorKind::Usage, "{} '{}' gives '{}' twice: give it once", name, quotedPart(text), quotedPart(key));
  }
  return keys;
}

int readWord(const std::string& name, const std::vector<std::string>& words, const std::string& text) {
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) fail(ErrorKind::Usage, "{} takes '{}', not '{}'", name, fmt::join(words, "' or '"), quotedPart(text));
  return int(found - words.begin());
}

ValueWindow readWindow(const std::string& name, const std::string& text) {
  constexpr std::string_view kDots = "..";
  const std::size_t dots = text.find(kDots);
  ValueWindow window;
  if (dots != text.npos) {
    const NumberForm end{.name = name, .form = kWindowForm, .range = {-1e30, 1e30}};
    window = {readNumbers(end, text.substr(0, dots))[0], readNumbers(end, text.substr(dots + kDots.size()))[0]};
  } else {
    const auto n = readNumbers({.name = name, .form = kWindowForm, .count = 2, .range = {-1e30, 1e30}}, text);
    const auto decimal = [](double end) { return std::stod(fmt::format("{:.15g}", end)); };  // 0.5,0.8 is 0.1..0.9
    window = {decimal(n[0] - 0.5 * n[1]), decimal(n[0] + 0.5 * n[1])};
  }
  if (!(float(window.low) < float(window.high)))
    fail(ErrorKind::Usage, "{} '{}' has no width: give CENTER,WIDTH with a width above 0, or LO..HI with LO below HI", name,
         quotedPart(text));
  return window;
}

std::string windowText(const ValueWindow& window) {
  return numberText(window.low) + ".." + numberText(window.high);
}

SlicePlane readSlicePlane(const std::string& name, const std::string& text) {
  const NumberForm form{.name = name, .form = kSliceForm, .range = {-1e30, 1e30}};
  if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || text[1] != ':')
    fail(ErrorKind::Usage, "{} takes {} with an axis x, y or z, as z:12.5 or z:50%, not '{}'", name, kSliceForm, quotedPart(text));
  SlicePlane plane{.axis = text[0] - 'x', .isPercent = text.ends_with('%')};
  plane.position = readNumbers(form, text.substr(2, text.size() - (plane.isPercent ? 3 : 2)))[0];
  return plane;
}

std::string slicePlaneText(const SlicePlane& plane) {
  return fmt::format("{}:{}{}", "xyz"[plane.axis], plane.position, plane.isPercent ? "%" : "");
}

bool isInlineJson(const std::string& text) {
  return text.starts_with('{');
}

std::string numberText(double value) {
  return fmt::format("{}", value);
}

std::string numberText(glm::dvec3 value) {
  return fmt::format("{},{},{}", value.x, value.y, value.z);
}

}  // namespace freevoxels
