#include "engine/image/flip.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/flip_tile.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

/// Edge of a tile in pixels: its planes fit into a core's cache, and memory does not grow with the image.
constexpr int kTileSide = 128;

/// Narkowicz's fit of ACES with the exposure that the HDR-FLIP paper gives it: (a x^2 + b x) / (c x^2 + d x +
/// e).
struct AcesFit {
  double a = 0.6 * 0.6 * 2.51, b = 0.6 * 0.03, c = 0.6 * 0.6 * 2.43, d = 0.6 * 0.59, e = 0.14;

  float operator()(float x) const {
    x = std::clamp(x, 0.0f, 1e6f);  // far beyond white, and no overflow
    return (float(a) * x * x + float(b) * x) / (float(c) * x * x + float(d) * x + float(e));
  }
  /// The x > 0 that maps to y, where y c < a.
  double inverse(double y) const {
    const double square = a - y * c, linear = b - y * d;
    return (-linear + std::sqrt(linear * linear + 4.0 * square * y * e)) / (2.0 * square);
  }
};

constexpr AcesFit kAces;
constexpr double kExposedTo = 0.85;  // the paper's target for the brightest and for the median pixel
constexpr double kMinLuminance = 0x1p-23;

/// How a pixel is displayed: multiplied by a factor and tone-mapped, or as it is if there is no factor.
struct Display {
  float exposureFactor = 0.0f;

  void show(const glm::vec4& pixel, float color[3]) const {
    for (int c = 0; c < 3; ++c)
      color[c] = exposureFactor > 0.0f ? kAces(exposureFactor * pixel[c]) : pixel[c];
  }
};

/// The pixels [begin, begin + size) and `margin` more on every side. Beyond the image its border pixels are
/// repeated.
DisplayedTile displayTile(const Image& image, glm::ivec2 begin, glm::ivec2 size, int margin,
                          const Display& display) {
  DisplayedTile tile(size.x + 2 * margin, size.y + 2 * margin);
  for (int y = 0; y < size.y + 2 * margin; ++y) {
    const std::size_t row = std::size_t(std::clamp(begin.y + y - margin, 0, image.size.y - 1));
    for (int x = 0; x < size.x + 2 * margin; ++x) {
      const std::size_t column = std::size_t(std::clamp(begin.x + x - margin, 0, image.size.x - 1));
      float color[3];
      display.show(image.pixels[row * std::size_t(image.size.x) + column], color);
      tile.set(x, y, color);
    }
  }
  return tile;
}

/// The maximum of FLIP over the displays, per pixel.
FlipMap largestFlip(const Image& test, const Image& reference, const std::vector<Display>& displays,
                    double pixelsPerDegree) {
  FV_CHECK_EQ(test.size.x, reference.size.x);
  FV_CHECK_EQ(test.size.y, reference.size.y);
  const FlipFilters filters(pixelsPerDegree);
  FlipMap map{test.size, std::vector<float>(test.pixels.size())};
  const auto fillTile = [&](glm::ivec2 begin) {
    const glm::ivec2 size = glm::min(glm::ivec2(kTileSide), map.size - begin);
    for (const Display& display : displays) {
      const Plane tile = flipTile(displayTile(test, begin, size, filters.margin(), display),
                                  displayTile(reference, begin, size, filters.margin(), display), filters);
      for (int y = 0; y < size.y; ++y) {
        float* row = &map.values[std::size_t(begin.y + y) * std::size_t(map.size.x) + std::size_t(begin.x)];
        for (int x = 0; x < size.x; ++x) row[x] = std::max(row[x], tile.row(y)[x]);
      }
    }
  };
  const glm::ivec2 tiles = (map.size + kTileSide - 1) / kTileSide;
  tbb::parallel_for(tbb::blocked_range2d<int>(0, tiles.y, 1, 0, tiles.x, 1), [&](const auto& range) {
    for (int y = range.rows().begin(); y < range.rows().end(); ++y)
      for (int x = range.cols().begin(); x < range.cols().end(); ++x) fillTile(glm::ivec2(x, y) * kTileSide);
  });
  return map;
}

}  // namespace

double FlipMap::mean() const {
  double sum = 0.0;
  for (const float value : values) sum += value;
  return sum / double(values.size());
}

FlipMap ldrFlip(const Image& test, const Image& reference, double pixelsPerDegree) {
  return largestFlip(test, reference, {Display{}}, pixelsPerDegree);
}

FlipMap hdrFlip(const Image& test, const Image& reference, const Exposures& exposures,
                double pixelsPerDegree) {
  FV_CHECK_LT(0, exposures.count);
  std::vector<Display> displays;
  for (int i = 0; i < exposures.count; ++i) {
    const double share = exposures.count > 1 ? double(i) / (exposures.count - 1) : 0.0;
    const double stops = exposures.start + share * (exposures.stop - exposures.start);
    displays.push_back({float(std::exp2(stops))});
  }
  return largestFlip(test, reference, displays, pixelsPerDegree);
}

Exposures exposuresBetween(double start, double stop) {
  return {start, stop, std::max(2, int(std::ceil(stop - start)))};
}

Exposures flipExposures(const Image& reference) {
  std::vector<double> luminances;
  luminances.reserve(reference.pixels.size());
  for (const glm::vec4& pixel : reference.pixels)
    luminances.push_back(0.2126 * pixel.r + 0.7152 * pixel.g + 0.0722 * pixel.b);
  const double brightest = *std::ranges::max_element(luminances);
  const auto median = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
  std::ranges::nth_element(luminances, median);

  const auto exposureOf = [](double luminance) { return std::log2(kAces.inverse(kExposedTo) / std::max(luminance, kMinLuminance)); };
  return exposuresBetween(exposureOf(brightest), exposureOf(*median));
}

Image magmaImage(const FlipMap& map) {
  // Every fifteenth of matplotlib's 256 colours (CC0). Linear interpolation reproduces the others to 3/255.
  constexpr glm::vec3 kMagma[] = {
      {0, 0, 4},      {9, 7, 32},      {26, 16, 66},    {49, 17, 101},   {74, 16, 121},   {98, 25, 128},
      {121, 34, 130}, {145, 43, 129},  {170, 51, 125},  {194, 59, 117},  {217, 70, 107},  {236, 88, 96},
      {247, 114, 92}, {252, 142, 100}, {254, 170, 116}, {254, 198, 138}, {253, 226, 163}, {252, 253, 191}};
  constexpr int kLast = int(std::size(kMagma)) - 1;
  Image image{map.size, {}, {}};
  image.pixels.reserve(map.values.size());
  for (const float value : map.values) {
    const float position = std::clamp(value, 0.0f, 1.0f) * float(kLast);
    const int i = std::min(int(position), kLast - 1);
    const glm::vec3 srgb = glm::mix(kMagma[i], kMagma[i + 1], position - float(i)) / 255.0f;
    image.pixels.emplace_back(linearFromSrgb(srgb.r), linearFromSrgb(srgb.g), linearFromSrgb(srgb.b), 1.0f);
  }
  return image;
}

}  // namespace freevoxels
