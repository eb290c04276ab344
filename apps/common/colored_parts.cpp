#include "apps/common/colored_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/image/srgb.h"
#include "engine/renderer.h"

namespace freevoxels {

namespace {

/// Steps of this part of a turn keep any number of consecutive hues apart.
constexpr double kGoldenRatio = 0.6180339887498949;
constexpr double kSaturation = 0.85;

void color(FixedSums& sums, glm::dvec3 color) {
  const std::size_t pixels = sums.pixelCount();
  std::int64_t* const values = sums.values.data();
  for (std::size_t i = 0; i < pixels; ++i) {
    double luminance = 0.0;
    for (int c = 0; c < 3; ++c) luminance += kLuminance[c] * double(values[std::size_t(c) * pixels + i]);
    for (int c = 0; c < 3; ++c) values[std::size_t(c) * pixels + i] = std::int64_t(luminance * color[c]);
  }
}

}  // namespace

glm::dvec3 partColor(int part) {
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c) {
    const double turn = kGoldenRatio * part + 1.0 - c / 3.0;
    const double pure = std::clamp(std::abs(6.0 * (turn - std::floor(turn)) - 3.0) - 1.0, 0.0, 1.0);
    result[c] = double(linearFromSrgb(float(1.0 - kSaturation * (1.0 - pure))));
  }
  return result;
}

FixedSums drawColoredParts(Renderer& renderer, const Camera& camera, const FrameSettings& settings, int parts, const Progress& progress) {
  FixedSums all;
  for (int part = 0; part < parts; ++part) {
    Progress ofPart;
    if (progress)
      ofPart = [&](std::string_view stage, double fraction) {
        progress(fmt::format("part {} of {}: {}", part + 1, parts, stage), fraction);
      };
    FixedSums sums = renderer.renderShares(camera, settings, {part, parts}, ofPart);
    color(sums, partColor(part));
    if (part == 0)
      all = std::move(sums);
    else
      all += sums;
  }
  return all;
}

}  // namespace freevoxels
