#include "engine/storage/fvx_description.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/core/printable.h"

namespace freevoxels::fvx {

namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, kChannels> kChannelNames{"scalars", "temperature", "albedo"};
constexpr double kMaxFloat = std::numeric_limits<float>::max(), kMaxDouble = std::numeric_limits<double>::max();

template <typename Vector>
Json triple(const Vector& v) {
  return {v.x, v.y, v.z};
}

[[noreturn]] void refuse(const char* what) {
  throw std::runtime_error(fmt::format("{} is impossible", what));
}

/// A number that is an integer between two others.
template <typename Integer>
Integer integer(const Json& json, Integer low, Integer high, const char* what) {
  const bool fits = json.is_number_unsigned() ? std::cmp_less_equal(json.get<std::uint64_t>(), high) && std::cmp_greater_equal(json.get<std::uint64_t>(), low)
                                              : json.is_number_integer() && std::cmp_less_equal(json.get<std::int64_t>(), high) &&
                                                    std::cmp_greater_equal(json.get<std::int64_t>(), low);
  if (!fits) refuse(what);
  return json.get<Integer>();
}

std::uint64_t count(const Json& json, std::uint64_t most, const char* what) {
  return integer<std::uint64_t>(json, 0, most, what);
}

/// A finite number in a range.
double number(const Json& json, double low, double high, const char* what) {
  const double value = json.get<double>();
  if (!(value >= low && value <= high)) refuse(what);
  return value;
}

/// A number that a float holds.
float real(const Json& json, const char* what) {
  return float(number(json, -kMaxFloat, kMaxFloat, what));
}

/// The numbers of a list of `value(element)`.
template <glm::length_t N, typename Value>
auto vectorOf(const Json& json, const Value& value, const char* what) {
  if (!json.is_array() || json.size() != std::size_t(N)) refuse(what);
  glm::vec<N, decltype(value(json))> result;
  for (glm::length_t i = 0; i < N; ++i) result[i] = value(json[std::size_t(i)]);
  return result;
}

/// For messages: one line without control characters.
std::string text(const Json& json) {
  constexpr std::size_t kLongest = 200;
  return printablePart(json.get_ref<const std::string&>(), kLongest);
}

Json functionJson(const TransferFunction& function) {
  Json json{{"opacity", Json::array()}, {"color", Json::array()}, {"unit_distance", function.unitDistance}};
  for (const auto& [scalar, opacity] : function.opacity) json["opacity"].push_back({scalar, opacity});
  for (const auto& [scalar, color] : function.color) json["color"].push_back({scalar, color.r, color.g, color.b});
  return json;
}

/// Points over scalars that do not descend, each with N values between 0 and 1.
template <glm::length_t N, typename Point>
std::vector<Point> readPoints(const Json& json, const char* what) {
  if (!json.is_array() || json.empty()) refuse(what);
  std::vector<Point> points;
  for (const Json& point : json) {
    if (!point.is_array() || point.size() != 1 + std::size_t(N)) refuse(what);
    const float scalar = real(point[0], what);
    if (!points.empty() && scalar < points.back().scalar) refuse(what);
    glm::vec<N, float> values;
    for (glm::length_t i = 0; i < N; ++i) values[i] = float(number(point[1 + std::size_t(i)], 0.0, 1.0, what));
    if constexpr (N == 1)
      points.push_back({scalar, values[0]});
    else
      points.push_back({scalar, values});
  }
  return points;
}

TransferFunction readFunction(const Json& json) {
  TransferFunction function;
  function.opacity = readPoints<1, TransferFunction::OpacityPoint>(json.at("opacity"), "the opacity of its transfer function");
  function.color = readPoints<3, TransferFunction::ColorPoint>(json.at("color"), "the colour of its transfer function");
  function.unitDistance = number(json.at("unit_distance"), std::numeric_limits<double>::min(), kMaxFloat, "unit_distance");
  return function;
}

Json classificationJson(const Volume& volume) {
  const Classification& classification = *volume.classification;
  Json json{{"fixed", volume.classificationIsFixed},
            {"density_scale", classification.densityScale},
            {"albedo", triple(classification.albedo)}};
  if (classification.transferFunction) {
    json["transfer_function"] = functionJson(*classification.transferFunction);
    json["order"] = classification.order == ClassificationOrder::Post ? "post" : "pre";
  }
  if (classification.emission)
    json["emission"] = {{"strength", classification.emission->strength},
                        {"temperature_scale", classification.emission->temperatureScale},
                        {"temperature_offset", classification.emission->temperatureOffset}};
  return json;
}

Classification readClassification(const Json& json) {
  Classification classification;
  classification.densityScale = number(json.at("density_scale"), 0.0, kMaxDouble, "density_scale");
  classification.albedo =
      vectorOf<3>(json.at("albedo"), [](const Json& component) { return float(number(component, 0.0, 1.0, "albedo")); }, "albedo");
  if (json.contains("transfer_function")) {
    classification.transferFunction = readFunction(json["transfer_function"]);
    const std::string order = json.at("order");
    if (order != "pre" && order != "post") refuse("order");
    classification.order = order == "pre" ? ClassificationOrder::Pre : ClassificationOrder::Post;
  }
  if (json.contains("emission")) {
    const Json& emission = json["emission"];
    classification.emission =
        Emission{.strength = number(emission.at("strength"), 0.0, kMaxDouble, "strength"),
                 .temperatureScale = number(emission.at("temperature_scale"), -kMaxDouble, kMaxDouble, "temperature_scale"),
                 .temperatureOffset = number(emission.at("temperature_offset"), -kMaxDouble, kMaxDouble, "temperature_offset")};
  }
  return classification;
}

Json encodingsJson(const Encodings& encodings) {
  Json json = Json::array();
  for (std::size_t i = 0; i < encodings.size(); ++i)
    if (encodings[i])
      json.push_back({{"name", kChannelNames[i]},
                      {"number", i},
                      {"encoding", std::string(kEncodingNames[std::size_t(encodings[i]->kind)])},
                      {"scale", encodings[i]->scale},
                      {"offset", encodings[i]->offset}});
  return json;
}

/// Channels of later minor versions are skipped.
Encodings readEncodings(const Json& json) {
  if (!json.is_array()) refuse("channels");
  Encodings encodings;
  for (const Json& channel : json) {
    const auto place = count(channel.at("number"), std::numeric_limits<std::uint64_t>::max(), "number");
    if (place >= encodings.size()) continue;
    const std::string name = channel.at("encoding");
    const auto known = std::ranges::find(kEncodingNames, name);
    if (known == std::end(kEncodingNames)) throw std::runtime_error(fmt::format("encoding '{}' is unknown", text(name)));
    if (encodings[place]) throw std::runtime_error("a channel is there twice");
    encodings[place] = Encoding{.kind = EncodingKind(known - std::begin(kEncodingNames)),
                                .scale = number(channel.at("scale"), 0.0, kMaxDouble, "scale"),
                                .offset = number(channel.at("offset"), -kMaxFloat, kMaxFloat, "offset")};
  }
  if (!encodings[0]) throw std::runtime_error("it has no scalars");
  return encodings;
}

/// Affine, of voxels that have an extent along each axis in numbers that floats hold when they are squared, and that differ in position.
void readTransform(const Json& json, Volume& volume) {
  constexpr double kLargest = 1e15, kFlattest = 1e-9;  // world units; volume of a voxel relative to the box of its edge lengths
  constexpr double kFarthest = 1e12;                   // distance of the first voxel from the origin, in edges
  const auto refuseTransform = [] { throw std::runtime_error("its voxels have no extent or place, or one that is impossible"); };
  if (!json.is_array() || json.size() != 16) refuseTransform();
  for (int i = 0; i < 16; ++i) volume.indexToWorld[i / 4][i % 4] = number(json[std::size_t(i)], -kMaxDouble, kMaxDouble, "index_to_world");
  const glm::dmat4& m = volume.indexToWorld;
  double lengths = 1.0, shortest = kLargest;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(glm::dvec3(m[axis]));
    if (!(length < kLargest && length > 1.0 / kLargest) || m[axis][3] != 0.0) refuseTransform();
    lengths *= length;
    shortest = std::min(shortest, length);
  }
  if (m[3][3] != 1.0 || !(glm::length(glm::dvec3(m[3])) <= kFarthest * shortest)) refuseTransform();
  if (!(std::abs(glm::determinant(glm::dmat3(m))) > kFlattest * lengths)) refuseTransform();
}

void readBox(const Json& json, Volume& volume) {
  constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
  const auto coordinate = [](int low, int high, const char* what) { return [=](const Json& value) { return integer(value, low, high, what); }; };
  volume.dimensions = vectorOf<3>(json.at("dimensions"), coordinate(1, kLongestEdge, "an edge of its box"), "dimensions");
  volume.indexOrigin = vectorOf<3>(json.at("index_origin"), coordinate(kLeast, kMost, "index_origin"), "index_origin");
  if (glm::any(glm::greaterThan(volume.indexOrigin, kMost - (volume.dimensions - 1)))) refuse("index_origin");
}

void readCounts(const Json& json, Volume& volume) {
  volume.activeVoxels = count(json.at("active_voxels"), volume.voxelCount(), "active_voxels");
  volume.nanVoxels = count(json.at("nan_voxels"), volume.voxelCount(), "nan_voxels");
  volume.negativeVoxels = count(json.at("negative_voxels"), volume.activeVoxels, "negative_voxels");
  volume.minimum = real(json.at("minimum"), "minimum");
  volume.maximum = real(json.at("maximum"), "maximum");
  if (volume.minimum > volume.maximum) refuse("the range of its values");
}

TemperatureGrid readTemperature(const Json& json, std::uint64_t voxels) {
  TemperatureGrid grid{.name = text(json.at("name")), .values = {}};
  if (json.value("radiance", false)) throw std::runtime_error("its light has no colours of its own");  // version 1.3
  grid.isRadiance = json.value("light", false);
  grid.activeVoxels = count(json.at("active_voxels"), voxels, "active_voxels of temperatures");
  grid.nanVoxels = count(json.at("nan_voxels"), voxels, "nan_voxels of temperatures");
  grid.minimum = real(json.at("minimum"), "minimum of temperatures");
  grid.maximum = real(json.at("maximum"), "maximum of temperatures");
  if (grid.minimum > grid.maximum) refuse("the range of its temperatures");
  return grid;
}

Volume readVolume(const Json& json) {
  Volume volume;
  volume.source = text(json.at("source"));
  readBox(json, volume);
  readTransform(json.at("index_to_world"), volume);
  volume.up = vectorOf<3>(
      json.at("up"), [](const Json& component) { return number(component, -kMaxFloat, kMaxFloat, "up"); }, "up");
  if (!(glm::length(volume.up) > std::numeric_limits<float>::min())) refuse("up");
  volume.upReason = text(json.at("up_reason"));
  for (const auto& [key, unit] : {std::pair("length_unit", &volume.lengthUnit), {"value_unit", &volume.valueUnit}})
    if (json.contains(key)) *unit = text(json[key]);
  volume.isSolid = json.at("level_set").get<bool>();
  readCounts(json, volume);
  const Json& classification = json.at("classification");
  volume.classification = std::make_shared<const Classification>(readClassification(classification));
  volume.classificationIsFixed = classification.at("fixed").get<bool>();
  if (json.contains("temperature")) volume.temperature = readTemperature(json["temperature"], volume.voxelCount());
  if (volume.classification->emission && !volume.temperature) throw std::runtime_error("there is emission without temperatures");
  if (json.contains("albedo")) {
    const Json& albedo = json["albedo"];
    constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();  // it counts voxels beyond the volume's box too
    volume.albedo = AlbedoGrid{.name = text(albedo.at("name")), .values = {}, .clippedVoxels = count(albedo.at("clipped_voxels"), kMost, "clipped_voxels")};
  }
  return volume;
}

}  // namespace

std::string toJson(const Description& description) {
  const Volume& volume = description.volume;
  nlohmann::ordered_json json;
  json["source"] = volume.source;
  json["dimensions"] = triple(volume.dimensions);
  json["index_origin"] = triple(volume.indexOrigin);
  for (int i = 0; i < 16; ++i) json["index_to_world"].push_back(volume.indexToWorld[i / 4][i % 4]);
  json["up"] = triple(volume.up);
  json["up_reason"] = volume.upReason;
  if (!volume.lengthUnit.empty()) json["length_unit"] = volume.lengthUnit;
  if (!volume.valueUnit.empty()) json["value_unit"] = volume.valueUnit;
  json["level_set"] = volume.isSolid;
  json["active_voxels"] = volume.activeVoxels;
  json["nan_voxels"] = volume.nanVoxels;
  json["negative_voxels"] = volume.negativeVoxels;
  json["minimum"] = volume.minimum;
  json["maximum"] = volume.maximum;
  json["channels"] = encodingsJson(description.encodings);
  json["classification"] = classificationJson(volume);
  if (volume.temperature)
    json["temperature"] = {{"name", volume.temperature->name},
                           {"light", volume.temperature->isRadiance},
                           {"active_voxels", volume.temperature->activeVoxels},
                           {"nan_voxels", volume.temperature->nanVoxels},
                           {"minimum", volume.temperature->minimum},
                           {"maximum", volume.temperature->maximum}};
  if (volume.albedo)
    json["albedo"] = {{"name", volume.albedo->name}, {"clipped_voxels", volume.albedo->clippedVoxels}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Description parseDescription(std::string_view json, const std::filesystem::path& file) {
  const Json root = parseJson("the description of", file.string(), json);
  try {
    Description description{.volume = readVolume(root), .encodings = readEncodings(root.at("channels"))};
    const Volume& volume = description.volume;
    if (volume.temperature.has_value() != description.encodings[std::size_t(Channel::Temperature)].has_value() ||
        volume.albedo.has_value() != description.encodings[std::size_t(Channel::Albedo)].has_value())
      throw std::runtime_error("its channels do not match its grids");
    return description;
  } catch (const std::exception& error) {
    constexpr std::size_t kLongest = 200;
    fail(ErrorKind::Input, "'{}' cannot be read: its description does not say what it should ({}); bake it again", file.string(),
         printablePart(error.what(), kLongest));
  }
}

glm::vec2 Description::valueRange(Channel channel, int level) const {
  if (channel == Channel::Albedo) return {0.0f, 1.0f};
  if (channel == Channel::Temperature) {
    const TemperatureGrid& grid = *volume.temperature;
    return grid.isRadiance ? glm::vec2(0.0f, std::max(grid.maximum, 1.0f)) : glm::vec2(grid.minimum, grid.maximum);
  }
  // In means of densities, voxels without data and negative ones are 0.
  if (level > 0) return {std::min(volume.minimum, 0.0f), std::max(volume.maximum, 0.0f)};
  return {volume.minimum, volume.maximum};
}

std::uint64_t Description::activeVoxels(Channel channel) const {
  if (channel == Channel::Albedo) return std::numeric_limits<std::uint64_t>::max();  // which nobody counts
  return channel == Channel::Temperature ? volume.temperature->activeVoxels : volume.activeVoxels;
}

}  // namespace freevoxels::fvx
