#include "engine/image/display.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

/// 0 for NaN.
float clampUnit(float value) {
  return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

float filmicCurve(float x) {
  return (x * (0.15f * x + 0.05f) + 0.004f) / (x * (0.15f * x + 0.5f) + 0.06f) - 0.02f / 0.3f;
}

float toneMapped(ToneMap map, float light) {
  constexpr float kFilmicExposure = 2.0f, kFilmicWhite = 11.2f;
  switch (map) {
    case ToneMap::None: return light;
    case ToneMap::Filmic: return filmicCurve(kFilmicExposure * light) / filmicCurve(kFilmicWhite);
    case ToneMap::Aces: return light * (2.51f * light + 0.03f) / (light * (2.43f * light + 0.59f) + 0.14f);
  }
  return light;
}

void setAlpha(std::uint8_t& sample, float alpha) {
  sample = byteFromUnit(alpha);
}
void setAlpha(std::uint16_t& sample, float alpha) {
  sample = std::uint16_t(std::lround(65535.0f * alpha));
}

/// Writes one row of pixels.
template <typename Sample>
class RowWriter {
 public:
  RowWriter(const Image& image, const DisplayLook& look)
      : image_(image), look_(look), channels_(std::size_t(displayChannels(look))), gain_(float(std::exp2(look.exposure))) {}

  void write(int row, Sample* samples) const {
    const glm::vec3 behind = backgroundOf(row);
    std::array<Sample, 4> empty;  // a pixel without light, as many are
    writePixel(glm::vec4(0.0f), behind, empty.data());
    const glm::vec4* const pixels = &image_.pixels[std::size_t(row) * std::size_t(image_.size.x)];
    for (int x = 0; x < image_.size.x; ++x, samples += channels_)
      if (pixels[x] == glm::vec4(0.0f))
        std::copy_n(empty.data(), channels_, samples);
      else
        writePixel(pixels[x], behind, samples);
  }

 private:
  /// A part of an image has the background that is behind it in the whole.
  glm::vec3 backgroundOf(int row) const {
    if (!look_.background) return glm::vec3(0.0f);
    const int rows = image_.wholeSize.y > 0 ? image_.wholeSize.y : image_.size.y;
    return glm::mix(look_.background->top, look_.background->bottom, (float(row + image_.offset.y) + 0.5f) / float(rows));
  }

  void setColor(std::uint8_t& sample, float linear) const { sample = srgbByteFromLinear(buckets_, linear); }
  void setColor(std::uint16_t& sample, float linear) const { sample = std::uint16_t(std::lround(65535.0f * srgbFromLinear(linear))); }

  glm::vec4 shown(const glm::vec4& pixel) const {
    glm::vec4 result = pixel;
    for (int c = 0; c < 3; ++c) result[c] = toneMapped(look_.toneMap, gain_ * pixel[c]);
    return result;
  }

  /// Alpha above 1, which the additive composite makes, counts as 1. Straight alpha cannot be less than a colour that it is
  /// to show: where light exceeds the opacity, alpha grows by the exposed excess. The opacity itself does not depend on the exposure.
  void writePixel(const glm::vec4& light, const glm::vec3& behind, Sample* samples) const {
    const float most = look_.background ? light.a : std::max({light.a, light.r, light.g, light.b});
    const float excess = gain_ * (most - light.a);
    const float alpha = clampUnit(gain_ == 1.0f ? most : light.a + excess);
    const glm::vec4 pixel = shown(light);
    for (int c = 0; c < 3; ++c) {
      const float straight = alpha > 0.0f ? pixel[c] / alpha : 0.0f;
      setColor(samples[c], clampUnit(look_.background ? pixel[c] + (1.0f - alpha) * behind[c] : straight));
    }
    if (!look_.background) setAlpha(samples[3], alpha);
  }

  const Image& image_;
  const DisplayLook& look_;
  std::size_t channels_;
  float gain_;
  std::span<const std::uint32_t> buckets_ = srgbBuckets();
};

}  // namespace

template <typename Sample>
std::vector<Sample> displaySamples(const Image& image, const DisplayLook& look) {
  const RowWriter<Sample> writer(image, look);
  const std::size_t rowSamples = std::size_t(image.size.x) * std::size_t(displayChannels(look));
  std::vector<Sample> samples(rowSamples * std::size_t(image.size.y));
  tbb::parallel_for(0, image.size.y, [&](int row) { writer.write(row, samples.data() + std::size_t(row) * rowSamples); });
  return samples;
}

template std::vector<std::uint8_t> displaySamples(const Image&, const DisplayLook&);
template std::vector<std::uint16_t> displaySamples(const Image&, const DisplayLook&);

}  // namespace freevoxels
