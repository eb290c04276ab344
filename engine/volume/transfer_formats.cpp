#include "engine/volume/transfer_formats.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/nearest_name.h"
#include "engine/core/printable.h"
#include "engine/volume/transfer_interpolation.h"

namespace freevoxels {

namespace {

/// What does not come from a file has a unit distance of one millimetre in 3D Slicer.
constexpr double kSlicerUnitDistance = 1.0;

std::string_view withoutSpaces(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\r\n";
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(kSpaces);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

/// All numbers of a text with spaces between them; nothing if something else is in it.
std::optional<std::vector<double>> numbersIn(std::string_view text) {
  std::vector<double> numbers;
  for (text = withoutSpaces(text); !text.empty(); text = withoutSpaces(text)) {
    if (text.front() == '+') text.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || (end != text.data() + text.size() && std::string_view(" \t\r\n").find(*end) == std::string_view::npos))
      return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(std::size_t(end - text.data()));
  }
  return numbers;
}

/// The numbers of such a text after their count, in groups of `each`.
std::vector<double> countedNumbers(const TransferText& file, std::string_view text, std::size_t each) {
  if (withoutSpaces(text).empty()) return {};
  std::optional<std::vector<double>> numbers = numbersIn(text);
  if (!numbers || numbers->size() % each != 1 || numbers->front() != double(numbers->size() - 1))
    fail(ErrorKind::Input, "transfer function '{}' has '{}' where a count of numbers and groups of {} should be; correct that", file.name,
         quotedPart(text), each);
  numbers->erase(numbers->begin());
  return *numbers;
}

std::vector<std::string> linesOf(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// A .1dt: the count of entries, and red, green, blue and opacity of each, evenly over all values.
std::optional<TransferCurves> readTable(const TransferText& file, const std::vector<double>& numbers) {
  if (numbers.empty() || (numbers.size() - 1) % 4 != 0 || numbers.front() != double((numbers.size() - 1) / 4) || numbers.size() < 5)
    return std::nullopt;
  FileFunction function{.window = ValueWindow{0.0, 1.0}, .range = TransferCurves::Range::All};
  const std::size_t entries = (numbers.size() - 1) / 4;
  for (std::size_t i = 0; i < entries; ++i) {
    const double x = entries > 1 ? double(i) / double(entries - 1) : 0.0, *const entry = &numbers[1 + 4 * i];
    function.color.push_back({x, {entry[0], entry[1], entry[2]}});
    function.opacity.push_back({x, entry[3]});
  }
  return curvesOf(file.name, std::move(function));
}

/// A .vp: interpolation, shade, diffuse, ambient, specular and specular power, each on a line, and three functions.
std::optional<TransferCurves> readVolumeProperty(const TransferText& file) {
  constexpr std::size_t kScalarOpacity = 6, kGradientOpacity = 7, kColor = 8;
  std::vector<std::string> lines = linesOf(file.text);
  if (lines.size() <= kColor) return std::nullopt;
  for (std::size_t i = 0; i < kScalarOpacity; ++i)
    if (const auto numbers = numbersIn(lines[i]); !numbers || numbers->size() > 1) return std::nullopt;
  return readSlicerTexts(file, {lines[kScalarOpacity], lines[kGradientOpacity], lines[kColor]});
}

/// Names in short, for a sentence.
std::string someOf(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  const std::size_t shown = std::min(names.size(), kMost);
  std::vector<std::string> quoted;
  for (std::size_t i = 0; i < shown; ++i) quoted.push_back(quotedPart(names[i]));
  return fmt::format("{}{}", fmt::join(quoted, ", "), shown < names.size() ? fmt::format(" and {} more", names.size() - shown) : "");
}

}  // namespace

std::size_t indexOfWanted(const TransferText& file, const std::vector<std::string>& names) {
  if (names.empty()) fail(ErrorKind::Input, "transfer function '{}' has no function in it; name another file", file.name);
  if (file.wanted.empty() && names.size() == 1) return 0;
  if (file.wanted.empty())
    fail(ErrorKind::Input, "'{}' has {} transfer functions: name one of them, {}:NAME; they are {}", file.name, names.size(), file.name,
         someOf(names));
  const auto found = std::ranges::find(names, file.wanted);
  if (found != names.end()) return std::size_t(found - names.begin());
  fail(ErrorKind::Input, "'{}' has no transfer function '{}'{}; it has {}", file.name, quotedPart(file.wanted),
       suggestion(file.wanted, names), someOf(names));
}

TransferCurves readSlicerTexts(const TransferText& file, const SlicerTexts& texts) {
  FileFunction function{.unitDistance = kSlicerUnitDistance};
  const std::vector<double> opacity = countedNumbers(file, texts.scalarOpacity, 2), color = countedNumbers(file, texts.color, 4),
                            gradient = countedNumbers(file, texts.gradientOpacity, 2);
  for (std::size_t i = 0; i < opacity.size(); i += 2) function.opacity.push_back({opacity[i], opacity[i + 1]});
  for (std::size_t i = 0; i < color.size(); i += 4) function.color.push_back({color[i], {color[i + 1], color[i + 2], color[i + 3]}});
  for (std::size_t i = 1; i < gradient.size(); i += 2)
    if (gradient[i] != 1.0 && function.warnings.empty()) function.warnings.emplace_back(kGradientOpacityIsLost);
  return curvesOf(file.name, std::move(function));
}

std::optional<TransferCurves> readTransferNumbers(const TransferText& file) {
  if (const auto numbers = numbersIn(file.text))
    if (auto table = readTable(file, *numbers)) return table;
  return readVolumeProperty(file);
}

TransferCurves readTransferText(const TransferText& file) {
  const std::string_view text = withoutSpaces(file.text);
  const auto refuseName = [&] {
    if (!file.wanted.empty())
      fail(ErrorKind::Input, "'{}' has one transfer function without a name: leave out ':{}'", file.name, quotedPart(file.wanted));
  };
  if (text.starts_with('<')) return readTransferXml(file);
  if (!text.starts_with('{') && !text.starts_with('[')) {
    refuseName();
    if (auto curves = readTransferNumbers(file)) return *curves;
    if (!file.name.ends_with(".json"))
      fail(ErrorKind::Input,
           "transfer function '{}' is of no known format: it may be JSON of FreeVoxels, ParaView or VolView, or a file of 3D Slicer (.vp, .vp.json, "
           ".xml), ImageVis3D (.1dt), Inviwo (.itf) or Voreen (.tfi)",
           file.name);
  }
  const nlohmann::json root = parseJson("transfer function", file.name, text);
  if (isForeignJson(root)) return readForeignJson(file, root);
  refuseName();
  return parseTransferCurves(file.name, file.text);
}

}  // namespace freevoxels
