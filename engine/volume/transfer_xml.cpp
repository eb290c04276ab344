// Transfer functions of 3D Slicer, Inviwo and Voreen in XML.
#include <algorithm>
#include <array>
#include <limits>
#include <pugixml.hpp>

#include "engine/core/error.h"
#include "engine/volume/transfer_formats.h"
#include "engine/volume/transfer_interpolation.h"

namespace freevoxels {

namespace {

using pugi::xml_node;

/// Opacities of Inviwo and Voreen are those of so many steps along the box.
constexpr double kInviwoSteps = 150.0, kVoreenSteps = 200.0;

/// A number of an attribute; NaN, which curvesOf() refuses, where it is none.
double numberOf(xml_node node, const char* attribute, std::optional<double> usual = {}) {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found && usual) return *usual;
  return found ? found.as_double(std::numeric_limits<double>::quiet_NaN()) : std::numeric_limits<double>::quiet_NaN();
}

/// Makes values beyond `mask` transparent.
void maskOpacity(std::vector<FileOpacity>& points, const ValueWindow& mask, const ValueWindow& all) {
  if (points.empty() || (mask.low <= all.low && mask.high >= all.high) || !(mask.low < mask.high)) return;
  std::ranges::stable_sort(points, {}, &FileOpacity::scalar);
  const auto opacityAt = [points](double scalar) {
    const auto above = std::ranges::upper_bound(points, scalar, {}, &FileOpacity::scalar);
    if (above == points.begin()) return points.front().opacity;
    if (above == points.end()) return points.back().opacity;
    const FileOpacity& below = *(above - 1);
    return std::lerp(below.opacity, above->opacity, (scalar - below.scalar) / (above->scalar - below.scalar));
  };
  std::erase_if(points, [&](const FileOpacity& point) { return point.scalar <= mask.low || point.scalar >= mask.high; });
  const std::array<FileOpacity, 2> low{{{mask.low, 0.0}, {mask.low, opacityAt(mask.low)}}}, high{{{mask.high, opacityAt(mask.high)}, {mask.high, 0.0}}};
  points.insert(points.begin(), low.begin() + (mask.low <= all.low ? 1 : 0), low.end());
  points.insert(points.end(), high.begin(), high.end() - (mask.high >= all.high ? 1 : 0));
}

TransferCurves readSlicerXml(const TransferText& file, const std::vector<xml_node>& properties) {
  std::vector<std::string> names;
  for (const xml_node& property : properties)
    names.emplace_back(property.attribute("name") ? property.attribute("name").value() : property.attribute("id").value());
  const xml_node property = properties[indexOfWanted(file, names)];
  return readSlicerTexts(file, {property.attribute("scalarOpacity").value(), property.attribute("gradientOpacity").value(),
                                property.attribute("colorTransfer").value()});
}

/// The first child that has one of these names.
xml_node childOf(xml_node node, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const xml_node child = node.child(name)) return child;
  return {};
}

/// The list of points under names of several versions.
xml_node inviwoPoints(xml_node root) {
  return childOf(root, {"TFPrimitives", "Points", "dataPoints"});
}

TransferCurves readInviwo(const TransferText& file, xml_node root) {
  const bool isAbsolute = root.child("type").attribute("content").as_int() == 1;
  FileFunction function{.unitShare = 1.0 / kInviwoSteps};
  if (!isAbsolute) {
    function.range = TransferCurves::Range::All;
    function.window = ValueWindow{0.0, 1.0};
  }
  for (const xml_node point : inviwoPoints(root).children()) {
    const xml_node place = point.child("pos"), rgba = point.child("rgba");
    if (!place || !rgba) continue;
    const double x = numberOf(place, place.attribute("content") ? "content" : "x");
    function.color.push_back({x, {numberOf(rgba, "x"), numberOf(rgba, "y"), numberOf(rgba, "z")}});
    function.opacity.push_back({x, numberOf(rgba, "w")});
  }
  if (!isAbsolute)
    maskOpacity(function.opacity, {numberOf(root.child("maskMin"), "content", 0.0), numberOf(root.child("maskMax"), "content", 1.0)}, {0.0, 1.0});
  return curvesOf(file.name, std::move(function));
}

void addVoreenSide(FileFunction& function, double intensity, xml_node color) {
  const auto part = [&](const char* name) { return numberOf(color, name) / 255.0; };
  function.color.push_back({intensity, {part("r"), part("g"), part("b")}});
  function.opacity.push_back({intensity, part("a")});
}

TransferCurves readVoreen(const TransferText& file, xml_node keys) {
  const xml_node root = keys.parent(), domain = root.child("domain"), threshold = root.child("threshold");
  FileFunction function{.window = ValueWindow{0.0, 1.0}, .unitShare = 1.0 / kVoreenSteps};
  for (const xml_node key : keys.children()) {
    const double intensity = numberOf(key.child("intensity"), "value");
    addVoreenSide(function, intensity, key.child("colorL"));
    if (key.child("split").attribute("value").as_bool()) addVoreenSide(function, intensity, key.child("colorR"));
  }
  maskOpacity(function.opacity, {numberOf(threshold, "x", 0.0), numberOf(threshold, "y", 1.0)}, {0.0, 1.0});
  if (numberOf(root.child("gammaValue"), "value", 1.0) != 1.0) function.warnings.emplace_back("its gamma is drawn as 1");
  const int alphaMode = root.child("alphaMode").attribute("value").as_int(1);
  if (alphaMode != 1) function.warnings.emplace_back("its mode of alpha is drawn as that which uses its opacities");
  TransferCurves curves = curvesOf(file.name, std::move(function));
  const ValueWindow values{numberOf(domain, "x", 0.0), numberOf(domain, "y", 1.0)};
  if (!(float(values.low) < float(values.high)) || !std::isfinite(float(values.high - values.low)))
    fail(ErrorKind::Input, "transfer function '{}' has the domain {}..{}, which is no range; correct that", file.name, values.low, values.high);
  if (values == ValueWindow{0.0, 1.0}) {
    curves.range = TransferCurves::Range::All;
    return curves;
  }
  curves.window = values;
  return curves;
}

}  // namespace

TransferCurves readTransferXml(const TransferText& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(file.text.data(), file.text.size());
  if (!parsed)
    fail(ErrorKind::Input, "transfer function '{}' is not valid XML: {} at byte {}", file.name, parsed.description(), parsed.offset);
  const xml_node root = document.document_element();
  std::vector<xml_node> properties;
  for (const xml_node child : root.children("VolumeProperty")) properties.push_back(child);
  if (std::string_view(root.name()) == "VolumeProperty") properties.push_back(root);
  if (!properties.empty()) return readSlicerXml(file, properties);
  if (!file.wanted.empty())
    fail(ErrorKind::Input, "'{}' has one transfer function without a name: leave out the name behind the file", file.name);
  if (inviwoPoints(root)) return readInviwo(file, root);
  for (const xml_node child : root.children())
    if (const xml_node keys = child.child("Keys")) return readVoreen(file, keys);
  fail(ErrorKind::Input, "transfer function '{}' is XML, but none of 3D Slicer, Inviwo or Voreen that has a transfer function of one variable",
       file.name);
}

}  // namespace freevoxels
