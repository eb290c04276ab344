#include "engine/storage/fvx_description.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"

namespace freevoxels::fvx {

namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, kChannels> kChannelNames{"scalars", "temperature", "albedo"};

template <typename Vector>
Json triple(const Vector& v) {
  return {v.x, v.y, v.z};
}

template <typename Value>
glm::vec<3, Value> readTriple(const Json& json) {
  return {json.at(0).get<Value>(), json.at(1).get<Value>(), json.at(2).get<Value>()};
}

Json functionJson(const TransferFunction& function) {
  Json json{{"opacity", Json::array()}, {"color", Json::array()}, {"unit_distance", function.unitDistance}};
  for (const auto& [scalar, opacity] : function.opacity) json["opacity"].push_back({scalar, opacity});
  for (const auto& [scalar, color] : function.color) json["color"].push_back({scalar, color.r, color.g, color.b});
  return json;
}

TransferFunction readFunction(const Json& json) {
  TransferFunction function;
  function.unitDistance = json.at("unit_distance");
  for (const Json& point : json.at("opacity")) function.opacity.push_back({point.at(0), point.at(1)});
  for (const Json& point : json.at("color"))
    function.color.push_back({point.at(0), {point.at(1).get<float>(), point.at(2).get<float>(), point.at(3).get<float>()}});
  if (function.opacity.empty() || function.color.empty() || !(function.unitDistance > 0.0))
    throw std::runtime_error("its transfer function is empty");
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
  classification.densityScale = json.at("density_scale");
  classification.albedo = readTriple<float>(json.at("albedo"));
  if (json.contains("transfer_function")) {
    classification.transferFunction = readFunction(json["transfer_function"]);
    classification.order = json.at("order") == "pre" ? ClassificationOrder::Pre : ClassificationOrder::Post;
  }
  if (json.contains("emission")) {
    const Json& emission = json["emission"];
    classification.emission = Emission{.strength = emission.at("strength"),
                                       .temperatureScale = emission.at("temperature_scale"),
                                       .temperatureOffset = emission.at("temperature_offset")};
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
  Encodings encodings;
  for (const Json& channel : json) {
    const std::size_t number = channel.at("number");
    if (number >= encodings.size()) continue;
    const std::string name = channel.at("encoding");
    const auto known = std::ranges::find(kEncodingNames, name);
    if (known == std::end(kEncodingNames)) throw std::runtime_error(fmt::format("encoding '{}' is unknown", name));
    encodings[number] = Encoding{.kind = EncodingKind(known - std::begin(kEncodingNames)),
                                 .scale = channel.at("scale"),
                                 .offset = channel.at("offset")};
  }
  if (!encodings[0]) throw std::runtime_error("it has no scalars");
  return encodings;
}

void readTransform(const Json& json, Volume& volume) {
  for (int i = 0; i < 16; ++i) volume.indexToWorld[i / 4][i % 4] = json.at(std::size_t(i)).get<double>();
  const double extent = std::abs(glm::determinant(glm::dmat3(volume.indexToWorld)));
  if (!std::isfinite(extent) || !(extent > 0.0)) throw std::runtime_error("its voxels have no extent");
}

void readCounts(const Json& json, Volume& volume) {
  volume.activeVoxels = json.at("active_voxels");
  volume.nanVoxels = json.at("nan_voxels");
  volume.negativeVoxels = json.at("negative_voxels");
  volume.minimum = json.at("minimum");
  volume.maximum = json.at("maximum");
}

Volume readVolume(const Json& json) {
  Volume volume;
  volume.source = json.at("source");
  volume.dimensions = readTriple<int>(json.at("dimensions"));
  for (int axis = 0; axis < 3; ++axis)
    if (volume.dimensions[axis] < 1 || volume.dimensions[axis] > kLongestEdge)
      throw std::runtime_error(fmt::format("an edge of {} voxels is impossible", volume.dimensions[axis]));
  volume.indexOrigin = readTriple<int>(json.at("index_origin"));
  readTransform(json.at("index_to_world"), volume);
  volume.up = readTriple<double>(json.at("up"));
  volume.upReason = json.at("up_reason");
  volume.isLevelSet = json.at("level_set");
  readCounts(json, volume);
  const Json& classification = json.at("classification");
  volume.classification = std::make_shared<const Classification>(readClassification(classification));
  volume.classificationIsFixed = classification.at("fixed");
  if (json.contains("temperature")) {
    const Json& grid = json["temperature"];
    volume.temperature = TemperatureGrid{.name = grid.at("name"),
                                         .activeVoxels = grid.at("active_voxels"),
                                         .nanVoxels = grid.at("nan_voxels"),
                                         .minimum = grid.at("minimum"),
                                         .maximum = grid.at("maximum")};
  }
  if (volume.classification->emission && !volume.temperature) throw std::runtime_error("there is emission without temperatures");
  if (json.contains("albedo"))
    volume.albedo = AlbedoGrid{.name = json["albedo"].at("name"), .clippedVoxels = json["albedo"].at("clipped_voxels")};
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
  json["level_set"] = volume.isLevelSet;
  json["active_voxels"] = volume.activeVoxels;
  json["nan_voxels"] = volume.nanVoxels;
  json["negative_voxels"] = volume.negativeVoxels;
  json["minimum"] = volume.minimum;
  json["maximum"] = volume.maximum;
  json["channels"] = encodingsJson(description.encodings);
  json["classification"] = classificationJson(volume);
  if (volume.temperature)
    json["temperature"] = {{"name", volume.temperature->name},
                           {"active_voxels", volume.temperature->activeVoxels},
                           {"nan_voxels", volume.temperature->nanVoxels},
                           {"minimum", volume.temperature->minimum},
                           {"maximum", volume.temperature->maximum}};
  if (volume.albedo)
    json["albedo"] = {{"name", volume.albedo->name}, {"clipped_voxels", volume.albedo->clippedVoxels}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Description parseDescription(std::string_view json, const std::filesystem::path& file) {
  try {
    const Json root = Json::parse(json);
    Description description{.volume = readVolume(root), .encodings = readEncodings(root.at("channels"))};
    const Volume& volume = description.volume;
    if (volume.temperature.has_value() != description.encodings[std::size_t(Channel::Temperature)].has_value() ||
        volume.albedo.has_value() != description.encodings[std::size_t(Channel::Albedo)].has_value())
      throw std::runtime_error("its channels do not match its grids");
    return description;
  } catch (const std::exception& error) {
    fail(ErrorKind::Input, "'{}' cannot be read: its description does not say what it should ({}); bake it again", file.string(),
         error.what());
  }
}

}  // namespace freevoxels::fvx
