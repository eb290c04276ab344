// Transfer functions of ParaView, VolView and 3D Slicer in JSON.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/volume/transfer_formats.h"
#include "engine/volume/transfer_interpolation.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

constexpr std::array kParaViewKeys{"RGBPoints", "OpacityPoints", "Points", "ColorSpace", "IndexedColors"};
constexpr const char* kSlicerKey = "volumeProperties";

template <typename... Args>
[[noreturn]] void failIn(const TransferText& file, const char* key, fmt::format_string<Args...> format, Args&&... args) {
  fail(ErrorKind::Input, "transfer function '{}': \"{}\" {}", file.name, key, fmt::format(format, std::forward<Args>(args)...));
}

/// A list of numbers in groups of `each`; none if there is no such key.
std::vector<double> flatNumbers(const TransferText& file, const Json& object, const char* key, std::size_t each) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_array() || found->size() % each != 0) failIn(file, key, "must be a list of numbers in groups of {}", each);
  std::vector<double> numbers;
  for (const Json& value : *found) {
    if (!value.is_number()) failIn(file, key, "holds {} where a number should be", inShort(value));
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

double numberOf(const TransferText& file, const Json& object, const char* key, std::optional<double> usual = {}) {
  const auto found = object.find(key);
  if (found == object.end() && usual) return *usual;
  if (found == object.end() || !found->is_number()) failIn(file, key, "must be a number");
  return found->get<double>();
}

bool isTrue(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && ((found->is_boolean() && found->get<bool>()) || (found->is_number() && found->get<double>() != 0.0));
}

ColorSpace spaceOf(const TransferText& file, const Json& map, std::vector<std::string>& warnings) {
  static const std::map<std::string, ColorSpace> kSpaces{
      {"RGB", ColorSpace::Rgb},      {"HSV", ColorSpace::Hsv},   {"Wrapped", ColorSpace::HsvWrapped},
      {"Lab", ColorSpace::Lab},      {"CIELAB", ColorSpace::Lab}, {"Lab/CIEDE2000", ColorSpace::Lab},
      {"Diverging", ColorSpace::Diverging}, {"Step", ColorSpace::Step}};
  const auto found = map.find("ColorSpace");
  if (found == map.end()) return ColorSpace::Rgb;
  if (!found->is_string()) failIn(file, "ColorSpace", "must be a text, not {}", inShort(*found));
  const auto known = kSpaces.find(found->get<std::string>());
  if (known == kSpaces.end()) {
    warnings.push_back(fmt::format("its ColorSpace {} is not known, and its colours are interpolated as RGB", inShort(*found)));
    return ColorSpace::Rgb;
  }
  return known->second == ColorSpace::Hsv && isTrue(map, "HSVWrap") ? ColorSpace::HsvWrapped : known->second;
}

/// Colours of categories, each for an equal part of all values.
void takeIndexedColors(const TransferText& file, const Json& map, FileFunction& function) {
  const std::vector<double> rgb = flatNumbers(file, map, "IndexedColors", 3);
  const double count = double(rgb.size() / 3);
  for (std::size_t i = 0; i < rgb.size(); i += 3)
    for (const double side : {0.0, 1.0}) function.color.push_back({(double(i / 3) + side) / count, {rgb[i], rgb[i + 1], rgb[i + 2]}});
  function.warnings.push_back(fmt::format("its {} colours are of categories, and are drawn as steps", rgb.size() / 3));
}

/// Whether the scalars of the points are positions in a range, which ParaView brings over the values of the data: those of colour maps
/// without opacity, and of others that say so or begin at 0 and end at 1.
bool isRelative(const Json& map, const FileFunction& function) {
  if (map.contains("AbsoluteRange")) return !isTrue(map, "AbsoluteRange");
  if (function.opacity.empty()) return true;
  const auto [least, most] = std::ranges::minmax(function.opacity, {}, &FileOpacity::scalar);
  return least.scalar == 0.0 && most.scalar == 1.0;
}

void warnOfLosses(const Json& map, FileFunction& function) {
  if (isTrue(map, "UseLogScale") || isTrue(map, "LogScale")) function.warnings.emplace_back("its logarithmic scale is drawn as a linear one");
  if (isTrue(map, "UseBelowRangeColor") || isTrue(map, "UseAboveRangeColor"))
    function.warnings.emplace_back("its colours below and above its range are not drawn");
  if (map.contains("GaussianPoints") || map.contains("GradientOpacityPoints") || map.contains("Nodes"))
    function.warnings.emplace_back("its opacities of Gaussians, nodes and gradients are not drawn");
}

TransferCurves readParaView(const TransferText& file, const Json& map) {
  FileFunction function;
  function.space = spaceOf(file, map, function.warnings);
  const std::vector<double> rgb = flatNumbers(file, map, "RGBPoints", 4), points = flatNumbers(file, map, "Points", 4),
                            pairs = flatNumbers(file, map, "OpacityPoints", 2);
  for (std::size_t i = 0; i < rgb.size(); i += 4) function.color.push_back({rgb[i], {rgb[i + 1], rgb[i + 2], rgb[i + 3]}});
  for (std::size_t i = 0; i < points.size(); i += 4) function.opacity.push_back({points[i], points[i + 1], points[i + 2], points[i + 3]});
  for (std::size_t i = 0; i < pairs.size() && points.empty(); i += 2) function.opacity.push_back({pairs[i], pairs[i + 1]});
  if (rgb.empty() && map.contains("IndexedColors")) takeIndexedColors(file, map, function);
  if (!pairs.empty()) function.unitDistance = 1.0;
  if (map.contains("ScalarOpacityUnitDistance")) function.unitDistance = numberOf(file, map, "ScalarOpacityUnitDistance");
  if (function.unitDistance && !(*function.unitDistance > 0.0)) failIn(file, "ScalarOpacityUnitDistance", "must be a length above 0");
  if (isRelative(map, function)) function.range = function.opacity.empty() ? TransferCurves::Range::Usual : TransferCurves::Range::All;
  warnOfLosses(map, function);
  return curvesOf(file.name, std::move(function));
}

/// Names of the maps of a list; of those without a name their numbers.
std::vector<std::string> namesOf(const Json& list) {
  std::vector<std::string> names;
  for (const Json& map : list) {
    const auto name = map.find("Name");
    names.push_back(name != map.end() && name->is_string() ? name->get<std::string>() : fmt::format("{}", names.size()));
  }
  return names;
}

/// The points of a function of 3D Slicer; an empty list if there is none.
const Json& pointsOf(const TransferText& file, const Json& component, const char* key) {
  static const Json kNone = Json::array();
  const auto function = component.find(key);
  if (function == component.end()) return kNone;
  if (!function->is_object() || !function->contains("points") || !(*function)["points"].is_array())
    failIn(file, key, "must be an object with a list of \"points\"");
  for (const Json& point : (*function)["points"])
    if (!point.is_object()) failIn(file, key, "has {} among its points", inShort(point));
  return (*function)["points"];
}

TransferCurves readSlicerComponent(const TransferText& file, const Json& component) {
  FileFunction function{.unitDistance = numberOf(file, component, "scalarOpacityUnitDistance", 1.0)};
  if (!(*function.unitDistance > 0.0)) failIn(file, "scalarOpacityUnitDistance", "must be a length above 0");
  for (const Json& point : pointsOf(file, component, "scalarOpacity"))
    function.opacity.push_back({numberOf(file, point, "x"), numberOf(file, point, "y"), numberOf(file, point, "midpoint", 0.5),
                                numberOf(file, point, "sharpness", 0.0)});
  for (const Json& point : pointsOf(file, component, "rgbTransferFunction")) {
    const std::vector<double> rgb = flatNumbers(file, point, "color", 3);
    if (rgb.size() != 3) failIn(file, "color", "must be three numbers");
    function.color.push_back({numberOf(file, point, "x"), {rgb[0], rgb[1], rgb[2]}, numberOf(file, point, "midpoint", 0.5),
                              numberOf(file, point, "sharpness", 0.0)});
  }
  for (const Json& point : pointsOf(file, component, "gradientOpacity"))
    if (numberOf(file, point, "y") != 1.0 && function.warnings.empty() && !isTrue(component, "disableGradientOpacity"))
      function.warnings.emplace_back(kGradientOpacityIsLost);
  return curvesOf(file.name, std::move(function));
}

}  // namespace

bool isForeignJson(const Json& root) {
  const Json* map = &root;
  if (root.is_array() && !root.empty()) map = &root.front();
  if (!map->is_object()) return false;
  return map->contains(kSlicerKey) || std::ranges::any_of(kParaViewKeys, [&](const char* key) { return map->contains(key); });
}

TransferCurves readSlicerJson(const TransferText& file, const Json& root) {
  const Json& properties = root[kSlicerKey];
  if (!properties.is_array() || !std::ranges::all_of(properties, &Json::is_object)) failIn(file, kSlicerKey, "must be a list of objects");
  std::vector<std::string> names;
  for (const Json& property : properties) names.push_back(property.contains("name") && property["name"].is_string() ? property["name"].get<std::string>() : fmt::format("{}", names.size()));
  const Json& property = properties[indexOfWanted(file, names)];
  const auto components = property.find("components");
  if (components == property.end() || !components->is_array() || components->empty() || !components->front().is_object())
    failIn(file, "components", "must be a list of at least one object");
  TransferCurves curves = readSlicerComponent(file, components->front());
  if (components->size() > 1) curves.warnings.emplace_back("its components but the first are not drawn");
  return curves;
}

TransferCurves readForeignJson(const TransferText& file, const Json& root) {
  if (root.is_object() && root.contains(kSlicerKey)) return readSlicerJson(file, root);
  const Json list = root.is_array() ? root : Json::array({root});
  for (const Json& map : list)
    if (!map.is_object()) fail(ErrorKind::Input, "transfer function '{}' has {} among its maps; leave it out", file.name, inShort(map));
  return readParaView(file, list[indexOfWanted(file, namesOf(list))]);
}

}  // namespace freevoxels
