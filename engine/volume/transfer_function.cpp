// Transfer functions in the JSON of this project.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/volume/transfer_curves.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::array<std::string_view, 6> kKeys{"range", "opacity", "color", "unit_distance", "unit_share", "description"};
constexpr const char* kUsualRange = "usual";

/// A key of the file, with checked access to its value and messages that name it.
class Field {
 public:
  Field(const fs::path& file, std::string_view key, const Json& value)
      : file_(file), key_(key), value_(value) {}

  template <typename... Args>
  [[noreturn]] void failHere(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorKind::Input, "transfer function '{}': \"{}\" {}", file_.string(), key_,
         fmt::format(format, std::forward<Args>(args)...));
  }

  double number(const Json& value) const {
    if (!value.is_number()) failHere("holds {} where a number should be", value.type_name());
    const double number = value.get<double>();
    if (!std::isfinite(float(number))) failHere("holds the number {}, which is too large", number);
    return number;
  }
  double number() const { return number(value_); }

  /// A list of exactly N numbers.
  template <std::size_t N>
  std::array<double, N> tuple(const Json& value) const {
    if (!value.is_array() || value.size() != N) failHere("must have {} numbers in each of its lists", N);
    std::array<double, N> numbers;
    for (std::size_t i = 0; i < N; ++i) numbers[i] = number(value[i]);
    return numbers;
  }

  /// A list of points [x, value, ...]: x in 0..1 and ascending, values in 0..1.
  template <std::size_t N>
  std::vector<std::array<double, N>> points() const {
    if (!value_.is_array() || value_.empty()) failHere("must be a list of at least one point");
    std::vector<std::array<double, N>> points;
    for (const Json& value : value_) {
      const std::array<double, N> point = tuple<N>(value);
      for (const double x : point)
        if (x < 0.0 || x > 1.0) failHere("holds {}, which is not in 0..1", x);
      if (!points.empty() && !(point[0] > points.back()[0]))
        failHere("must have ascending points, but {} follows {}", point[0], points.back()[0]);
      points.push_back(point);
    }
    return points;
  }

  const Json& value() const { return value_; }

 private:
  const fs::path& file_;
  std::string_view key_;
  const Json& value_;
};

void checkKeys(const fs::path& file, const Json& root) {
  if (!root.is_object())
    fail(ErrorKind::Input, "transfer function '{}' is a JSON {}; it must be an object {{\"opacity\": ...}}",
         file.string(), root.type_name());
  for (const auto& [key, value] : root.items())
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
      fail(ErrorKind::Input, "transfer function '{}' has an unknown key {}; the known ones are: {}",
           file.string(), inShort(key), fmt::join(kKeys, ", "));
  if (!root.contains("opacity"))
    fail(ErrorKind::Input, "transfer function '{}' has no \"opacity\"; add a list of [x, alpha] points",
         file.string());
}

/// Sets what is at x = 0 and 1.
void readRange(const fs::path& file, const Json& root, TransferCurves& curves) {
  if (!root.contains("range")) return;
  const Field field(file, "range", root["range"]);
  if (field.value() == kUsualRange) {
    curves.range = TransferCurves::Range::Usual;
    return;
  }
  if (field.value().is_string()) field.failHere("must be [lo, hi] or \"{}\", not {}", kUsualRange, inShort(field.value()));
  const std::array<double, 2> range = field.tuple<2>(field.value());
  if (!(float(range[0]) < float(range[1])))
    field.failHere("must be [lo, hi] with lo below hi, but is [{}, {}]", range[0], range[1]);
  curves.range = TransferCurves::Range::Values;
  curves.window = {range[0], range[1]};
}

std::optional<double> readLength(const fs::path& file, const Json& root, const char* key) {
  if (!root.contains(key)) return std::nullopt;
  const Field field(file, key, root[key]);
  const double length = field.number();
  if (!(float(length) > 0.0f)) field.failHere("must be a length above 0, but is {}", length);
  return length;
}

/// Any text or none.
std::string readDescription(const fs::path& file, const Json& root) {
  if (!root.contains("description")) return "";
  const Json& text = root["description"];
  if (!text.is_string()) Field(file, "description", text).failHere("must be a text, not {}", inShort(text));
  return text.get<std::string>();
}

TransferCurves makeCurves(const fs::path& file, const Json& root) {
  checkKeys(file, root);
  TransferCurves curves;
  readRange(file, root, curves);
  curves.unitDistance = readLength(file, root, "unit_distance");
  curves.unitShare = readLength(file, root, "unit_share");
  curves.description = readDescription(file, root);
  if (curves.unitDistance && curves.unitShare)
    fail(ErrorKind::Input, "transfer function '{}' has \"unit_distance\" and \"unit_share\", which both say what opacity is of: keep one",
         file.string());
  for (const auto& [x, alpha] : Field(file, "opacity", root["opacity"]).points<2>()) curves.opacity.push_back({x, alpha});
  if (root.contains("color"))
    for (const auto& [x, r, g, b] : Field(file, "color", root["color"]).points<4>()) curves.color.push_back({x, {r, g, b}});
  return curves;
}

/// The double with the fewest digits that rounds to this float.
double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

}  // namespace

TransferCurves parseTransferCurves(const std::string& name, const std::string& json) {
  return makeCurves(name, parseJson("transfer function", name, json));
}

std::string transferFunctionJson(const TransferFunction& function) {
  const double low = std::min(function.opacity.front().scalar, function.color.front().scalar);
  const double high = std::max(function.opacity.back().scalar, function.color.back().scalar);
  const double width = high > low ? high - low : 1.0;
  nlohmann::ordered_json root;
  root["range"] = {low, low + width};
  for (const TransferFunction::OpacityPoint& point : function.opacity)
    root["opacity"].push_back({(point.scalar - low) / width, shortest(point.opacity)});
  for (const TransferFunction::ColorPoint& point : function.color)
    root["color"].push_back({(point.scalar - low) / width, shortest(point.color.r), shortest(point.color.g), shortest(point.color.b)});
  root["unit_distance"] = function.unitDistance;
  return root.dump();
}

std::string transferCurvesJson(const TransferCurves& curves) {
  const auto placed = [](double x) { return std::stod(fmt::format("{:.9g}", x)); };  // so that the sides of jumps stay apart
  const auto rounded = [](double value) { return std::stod(fmt::format("{:.6g}", value)); };
  nlohmann::ordered_json root;
  if (!curves.description.empty()) root["description"] = curves.description;
  if (curves.range == TransferCurves::Range::Values) root["range"] = {curves.window.low, curves.window.high};
  if (curves.range == TransferCurves::Range::Usual) root["range"] = kUsualRange;
  for (const auto& [x, opacity] : curves.opacity) root["opacity"].push_back({placed(x), rounded(opacity)});
  for (const auto& [x, color] : curves.color) root["color"].push_back({placed(x), rounded(color.r), rounded(color.g), rounded(color.b)});
  if (curves.unitDistance) root["unit_distance"] = *curves.unitDistance;
  if (curves.unitShare) root["unit_share"] = *curves.unitShare;
  std::vector<std::string> lines;
  for (const auto& [key, value] : root.items())
    lines.push_back(fmt::format("  \"{}\": {}", key, value.dump(-1, ' ', false, Json::error_handler_t::replace)));
  return fmt::format("{{\n{}\n}}\n", fmt::join(lines, ",\n"));
}

}  // namespace freevoxels
