#pragma once
// Differences between two images, pixel by pixel.

#include <optional>

#include "engine/image/image.h"

namespace freevoxels {

/// A channel of a pixel: `channel` is 0..3 for R, G, B, A; pixel (0, 0) is the top left.
struct ImagePosition {
  glm::ivec2 pixel{0};
  int channel = 0;
};

/// Metrics of premultiplied linear RGBA, without clamping. Alpha has the same weight as each colour, unless
/// both images are opaque everywhere: then only the three colours count.
struct ImageMetrics {
  double rmse = 0.0;     ///< root of the mean squared difference over pixels and counted channels
  double psnr = 0.0;     ///< dB for a peak of 1: -20 log10(rmse); +infinity if the images are equal
  double maximum = 0.0;  ///< largest absolute difference
  ImagePosition where;   ///< position of the first maximum in reading order
  bool countsAlpha = false;
};

/// Compares two finite images of equal size. The result does not depend on the number of threads.
ImageMetrics compareImages(const Image& test, const Image& reference);

/// The first NaN or infinity in reading order, if there is one. Depth is ignored.
std::optional<ImagePosition> findNonFinite(const Image& image);

/// The opaque image colour + (1 - alpha) * background, with alpha clamped to 0..1 as in writePng.
/// `background` is linear.
Image compositeOver(const Image& image, const glm::vec3& background);

/// |test - reference| of every channel, for an EXR viewer.
Image absoluteDifference(const Image& test, const Image& reference);

}  // namespace freevoxels
