#include "engine/image/metrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

void checkSameSize(const Image& test, const Image& reference) {
  FV_CHECK_EQ(test.size.x, reference.size.x);
  FV_CHECK_EQ(test.size.y, reference.size.y);
  FV_CHECK_EQ(test.pixels.size(), reference.pixels.size());
}

bool isOpaque(const Image& image) {
  return std::ranges::all_of(image.pixels, [](const glm::vec4& pixel) { return pixel.a == 1.0f; });
}

struct RowDifference {
  double squares = 0.0;
  double maximum = -1.0;
  ImagePosition where;
};

RowDifference compareRow(const Image& test, const Image& reference, int y, int channels) {
  RowDifference row;
  const std::size_t first = std::size_t(y) * std::size_t(test.size.x);
  for (int x = 0; x < test.size.x; ++x)
    for (int c = 0; c < channels; ++c) {
      const std::size_t i = first + std::size_t(x);
      const double difference = std::abs(double(test.pixels[i][c]) - double(reference.pixels[i][c]));
      row.squares += difference * difference;
      if (difference > row.maximum) {
        row.maximum = difference;
        row.where = {{x, y}, c};
      }
    }
  return row;
}

}  // namespace

ImageMetrics compareImages(const Image& test, const Image& reference) {
  checkSameSize(test, reference);
  ImageMetrics metrics;
  metrics.countsAlpha = !isOpaque(test) || !isOpaque(reference);
  const int channels = metrics.countsAlpha ? 4 : 3;
  std::vector<RowDifference> rows(std::size_t(test.size.y));
  tbb::parallel_for(0, test.size.y,
                    [&](int y) { rows[std::size_t(y)] = compareRow(test, reference, y, channels); });

  double squares = 0.0;
  metrics.maximum = -1.0;
  for (const RowDifference& row : rows) {  // in a fixed order, whichever thread computed them
    squares += row.squares;
    if (row.maximum > metrics.maximum) {
      metrics.maximum = row.maximum;
      metrics.where = row.where;
    }
  }
  const double mean = squares / (double(test.pixels.size()) * channels);
  metrics.rmse = std::sqrt(mean);
  metrics.psnr = mean > 0.0 ? -10.0 * std::log10(mean) : std::numeric_limits<double>::infinity();
  return metrics;
}

std::optional<ImagePosition> findNonFinite(const Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      if (!std::isfinite(image.pixels[i][c])) {
        const std::size_t width = std::size_t(image.size.x);
        return ImagePosition{{int(i % width), int(i / width)}, c};
      }
  return std::nullopt;
}

Image compositeOver(const Image& image, const glm::vec3& background) {
  Image result{image.size, image.pixels, {}};
  for (glm::vec4& pixel : result.pixels) {
    const float alpha = std::clamp(pixel.a, 0.0f, 1.0f);
    pixel = glm::vec4(glm::vec3(pixel) + (1.0f - alpha) * background, 1.0f);
  }
  return result;
}

Image absoluteDifference(const Image& test, const Image& reference) {
  checkSameSize(test, reference);
  Image result{test.size, test.pixels, {}};
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = glm::abs(result.pixels[i] - reference.pixels[i]);
  return result;
}

}  // namespace freevoxels
