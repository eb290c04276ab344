#include "engine/description/aov.h"

#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

struct AovName {
  const char* word;
  bool Aovs::*member;
};
constexpr std::array<AovName, 6> kAovs{{{"depth", &Aovs::depth},
                                        {"position", &Aovs::position},
                                        {"normal", &Aovs::normal},
                                        {"transmittance", &Aovs::transmittance},
                                        {"lights", &Aovs::lights},
                                        {"channels", &Aovs::channels}}};

/// The points that are seen, in the world.
class SeenPoints {
 public:
  SeenPoints(const Image& image, const Camera& camera)
      : image_(image), rays_(pixelRays(camera, image.size, glm::dmat4(1.0))) {}

  bool has(int x, int y) const {
    return x >= 0 && y >= 0 && x < image_.size.x && y < image_.size.y && std::isfinite(depth(x, y));
  }
  float depth(int x, int y) const { return image_.depth[std::size_t(y) * std::size_t(image_.size.x) + std::size_t(x)]; }

  glm::dvec3 at(int x, int y) const {
    const double u = x + 0.5, v = y + 0.5;
    return rays_.origin + u * rays_.originX + v * rays_.originY +
           double(depth(x, y)) * (rays_.direction + u * rays_.directionX + v * rays_.directionY);
  }

  /// Towards the eye; 0 where the neighbours of the pixel do not span a surface.
  glm::dvec3 normal(int x, int y) const {
    const glm::dvec3 normal = glm::cross(step(x, y, {1, 0}), step(x, y, {0, 1}));
    const double length = glm::length(normal);
    if (!(length > 0.0)) return glm::dvec3(0.0);
    const glm::dvec3 view = rays_.direction + (x + 0.5) * rays_.directionX + (y + 0.5) * rays_.directionY;
    return normal / (glm::dot(normal, view) > 0.0 ? -length : length);
  }

 private:
  /// From the pixel to the next one, on the side where the depth changes less: at silhouettes the other side is another surface.
  glm::dvec3 step(int x, int y, glm::ivec2 along) const {
    const glm::ivec2 pixel(x, y), after = pixel + along, before = pixel - along;
    const bool hasAfter = has(after.x, after.y), hasBefore = has(before.x, before.y);
    const auto change = [&](glm::ivec2 other) { return std::abs(depth(other.x, other.y) - depth(x, y)); };
    if (hasAfter && (!hasBefore || change(after) <= change(before))) return at(after.x, after.y) - at(x, y);
    if (hasBefore) return at(x, y) - at(before.x, before.y);
    return glm::dvec3(0.0);
  }

  const Image& image_;
  const PixelRays rays_;
};

/// Adds NAME.X, NAME.Y and NAME.Z of `vectorAt(x, y)` where something is seen.
template <typename VectorAt>
void addVectors(Image& image, const std::string& name, const SeenPoints& points, const VectorAt& vectorAt) {
  std::array<std::vector<float>, 3> channels;
  channels.fill(std::vector<float>(image.pixels.size(), 0.0f));
  tbb::parallel_for(0, image.size.y, [&](int y) {
    for (int x = 0; x < image.size.x; ++x) {
      if (!points.has(x, y)) continue;
      const glm::dvec3 vector = vectorAt(x, y);
      for (int c = 0; c < 3; ++c)
        channels[std::size_t(c)][std::size_t(y) * std::size_t(image.size.x) + std::size_t(x)] = float(vector[c]);
    }
  });
  for (std::size_t c = 0; c < 3; ++c) image.channels[name + "." + "XYZ"[c]] = std::move(channels[c]);
}

}  // namespace

Aovs readAovs(const std::string& name, const std::string& text) {
  Aovs aovs;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const auto named = std::ranges::find_if(kAovs, [&](const AovName& aov) { return aov.word == word; });
    if (named == kAovs.end())
      fail(ErrorKind::Usage, "{} takes depth, position, normal, transmittance, lights and channels, with commas between them, not '{}'",
           name, quotedPart(word));
    aovs.*named->member = true;
    begin = end + 1;
  }
  return aovs;
}

std::string aovText(const Aovs& aovs) {
  std::vector<std::string> words;
  for (const AovName& name : kAovs)
    if (aovs.*name.member) words.emplace_back(name.word);
  return fmt::format("{}", fmt::join(words, ","));
}

void addChannels(Image& image, const Aovs& aovs, const Camera& camera) {
  if (aovs.needDepth()) {
    FV_CHECK_EQ(image.depth.size(), image.pixels.size());
    const SeenPoints points(image, camera);
    if (aovs.position) addVectors(image, "P", points, [&](int x, int y) { return points.at(x, y); });
    if (aovs.normal) addVectors(image, "N", points, [&](int x, int y) { return points.normal(x, y); });
  }
  if (aovs.transmittance) {
    std::vector<float>& values = image.channels["transmittance.Y"];
    for (const glm::vec4& pixel : image.pixels) values.push_back(std::max(1.0f - pixel.a, 0.0f));
  }
  if (!aovs.depth) image.depth.clear();
}

}  // namespace freevoxels
