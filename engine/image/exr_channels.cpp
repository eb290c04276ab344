#include "engine/image/exr_channels.h"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfStandardAttributes.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

std::string lowerCase(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The prefixes of the part's channels that have R, G and B: "" and "ViewLayer.Combined.".
std::vector<std::string> layersOf(const Imf::ChannelList& channels) {
  std::vector<std::string> layers;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::string name = channel.name();
    if (name != "R" && !name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    if (channels.findChannel(layer + "G") && channels.findChannel(layer + "B")) layers.push_back(layer);
  }
  return layers;
}

ExrColors colorsOf(int part, const Imf::ChannelList& channels, const std::string& layer) {
  const auto ifThere = [&](const std::string& name) { return channels.findChannel(name) ? name : std::string(); };
  return {.part = part, .names = {layer + "R", layer + "G", layer + "B", ifThere(layer + "A")}, .depth = ifThere(layer + "Z")};
}

/// Whether renderers call their image so.
bool isMainLayer(const std::string& layer) {
  static const std::set<std::string> kNames{"combined", "rgba", "rgb", "beauty", "color", "c"};
  const std::string name = lowerCase(layer.substr(0, layer.size() - 1));
  return kNames.contains(name.substr(name.rfind('.') + 1));
}

glm::dmat3 toXyz(const Imf::Chromaticities& colors) {
  const auto xyz = [](const Imath::V2f& at) { return glm::dvec3(at.x, at.y, 1.0 - at.x - at.y); };
  const glm::dmat3 primaries(xyz(colors.red), xyz(colors.green), xyz(colors.blue));
  const glm::dvec3 weights = glm::inverse(primaries) * (xyz(colors.white) / double(colors.white.y));
  return {primaries[0] * weights[0], primaries[1] * weights[1], primaries[2] * weights[2]};
}

/// Lindbloom, "Chromatic Adaptation", with Bradford's matrix.
glm::dmat3 adaptation(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dmat3 cones = glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 ratio = (cones * to) / (cones * from);
  return glm::inverse(cones) * glm::dmat3(ratio.x, 0, 0, 0, ratio.y, 0, 0, 0, ratio.z) * cones;
}

bool areNear(const Imf::Chromaticities& a, const Imf::Chromaticities& b) {
  constexpr float kTolerance = 1e-3f;
  return a.red.equalWithAbsError(b.red, kTolerance) && a.green.equalWithAbsError(b.green, kTolerance) &&
         a.blue.equalWithAbsError(b.blue, kTolerance) && a.white.equalWithAbsError(b.white, kTolerance);
}

}  // namespace

ExrColors findColors(const std::filesystem::path& file, const Imf::MultiPartInputFile& exr) {
  std::vector<std::pair<int, std::string>> layers;
  std::optional<int> grey;
  for (int part = 0; part < exr.parts(); ++part) {
    const Imf::ChannelList& channels = exr.header(part).channels();
    for (const std::string& layer : layersOf(channels)) {
      if (layer.empty()) return colorsOf(part, channels, layer);
      layers.emplace_back(part, layer);
    }
    if (!grey && channels.findChannel("Y") && !channels.findChannel("RY") && !channels.findChannel("BY")) grey = part;
  }
  const auto main = std::ranges::find_if(layers, [](const auto& layer) { return isMainLayer(layer.second); });
  if (main != layers.end() || layers.size() == 1) {
    const auto& [part, layer] = main != layers.end() ? *main : layers.front();
    return colorsOf(part, exr.header(part).channels(), layer);
  }
  if (layers.empty() && grey) {
    const auto ifThere = [&](const char* name) {
      return exr.header(*grey).channels().findChannel(name) ? std::string(name) : std::string();
    };
    return {.part = *grey, .names = {"Y", "Y", "Y", ifThere("A")}, .depth = ifThere("Z")};
  }
  if (layers.empty())
    fail(ErrorKind::Input, "cannot read '{}': it has no channels R, G and B, and no Y without chroma; write it with R, G and B",
         file.string());
  constexpr std::size_t kMaxNamed = 10;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(layers.size(), kMaxNamed); ++i)
    names.push_back(printable(layers[i].second.substr(0, layers[i].second.size() - 1)));
  fail(ErrorKind::Input,
       "cannot read '{}': it has {} layers with colours, {}{}, and none without a name: write the one to use as R, G and B", file.string(),
       layers.size(), fmt::join(names, ", "), layers.size() > kMaxNamed ? ", ..." : "");
}

ExrChannel findDepth(const std::filesystem::path& file, const Imf::MultiPartInputFile& exr) {
  std::vector<ExrChannel> all, ofDepth;
  for (int part = 0; part < exr.parts(); ++part) {
    const Imf::ChannelList& channels = exr.header(part).channels();
    if (channels.findChannel("Z")) return {.part = part, .name = "Z"};
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
      all.push_back({.part = part, .name = channel.name()});
      const std::string name = lowerCase(all.back().name);
      if (name == "depth.z" || name.ends_with(".depth.z")) ofDepth.push_back(all.back());
    }
  }
  if (ofDepth.size() == 1) return ofDepth.front();
  if (all.size() == 1) return all.front();
  fail(ErrorKind::Input, "cannot read depths of '{}': it has {} and no channel Z; write the one to use as Z", file.string(),
       ofDepth.empty() ? fmt::format("{} channels", all.size()) : fmt::format("{} layers of depths", ofDepth.size()));
}

std::optional<glm::dmat3> toRec709(const Imf::Header& header) {
  const Imf::Chromaticities rec709;  // OpenEXR's default
  if (!Imf::hasChromaticities(header)) return std::nullopt;
  const Imf::Chromaticities colors = Imf::chromaticities(header);
  if (areNear(colors, rec709)) return std::nullopt;
  const glm::dmat3 xyz = toXyz(colors), fromXyz = glm::inverse(toXyz(rec709));
  const bool areXyz =
      areNear({colors.red, colors.green, colors.blue, rec709.white}, {{1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, 0.0f}, rec709.white});
  const glm::dmat3 matrix = areXyz ? fromXyz : fromXyz * adaptation(xyz * glm::dvec3(1.0), toXyz(rec709) * glm::dvec3(1.0)) * xyz;
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(matrix[i].x + matrix[i].y + matrix[i].z)) return std::nullopt;  // no colours have such primaries
  return matrix;
}

}  // namespace freevoxels
