// Reads transfer functions from JSON.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/volume/classification.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::array<std::string_view, 4> kKeys{"range", "opacity", "color", "unit_distance"};

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

/// The scalars lo and hi at x = 0 and x = 1.
std::array<double, 2> readRange(const fs::path& file, const Json& root, const Volume& volume) {
  if (!root.contains("range")) return {volume.minimum, volume.maximum};
  const Field field(file, "range", root["range"]);
  const std::array<double, 2> range = field.tuple<2>(field.value());
  if (!(float(range[0]) < float(range[1])))
    field.failHere("must be [lo, hi] with lo below hi, but is [{}, {}]", range[0], range[1]);
  return range;
}

double readUnitDistance(const fs::path& file, const Json& root, const Volume& volume) {
  if (!root.contains("unit_distance")) return volume.voxelSize();
  const Field field(file, "unit_distance", root["unit_distance"]);
  const double distance = field.number();
  if (!(float(distance) > 0.0f)) field.failHere("must be a length above 0, but is {}", distance);
  return distance;
}

TransferFunction makeTransferFunction(const fs::path& file, const Json& root, const Volume& volume) {
  checkKeys(file, root);
  const std::array<double, 2> range = readRange(file, root, volume);
  const auto toScalar = [&](double x) { return float(range[0] + x * (range[1] - range[0])); };

  TransferFunction transfer;
  transfer.unitDistance = readUnitDistance(file, root, volume);
  for (const auto& [x, alpha] : Field(file, "opacity", root["opacity"]).points<2>())
    transfer.opacity.push_back({toScalar(x), float(alpha)});
  if (!root.contains("color")) {
    transfer.color.push_back({toScalar(0.0), glm::vec3(1.0f)});
    return transfer;
  }
  for (const auto& [x, r, g, b] : Field(file, "color", root["color"]).points<4>())
    transfer.color.push_back({toScalar(x), glm::vec3(float(r), float(g), float(b))});
  return transfer;
}

/// The double with the fewest digits that rounds to this float.
double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}

}  // namespace

TransferFunction readTransferFunction(const std::filesystem::path& file, const Volume& volume) {
  return makeTransferFunction(file, readJson("transfer function", file), volume);
}

TransferFunction parseTransferFunction(const std::string& json, const Volume& volume) {
  return makeTransferFunction("inline", parseJson("transfer function", "inline", json), volume);
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

}  // namespace freevoxels
