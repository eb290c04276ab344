#pragma once
// How far one picture is from another, pixel by pixel.

#include <optional>

#include "engine/image/image.h"

namespace freevoxels {

/// `channel` is 0..3 for R, G, B, A; pixel (0, 0) is the top left.
struct ImagePosition {
  glm::ivec2 pixel{0};
  int channel = 0;
};

/// Of premultiplied linear RGBA, without clamping. Alpha counts as much as each colour does, unless both
/// pictures are opaque everywhere: then it tells nothing and only the three colours count, as is usual.
struct ImageMetrics {
  double rmse = 0.0;     ///< root of the mean squared difference over pixels and counted channels
  double psnr = 0.0;     ///< dB for a peak of 1: -20 log10(rmse); +infinity where the pictures are equal
  double maximum = 0.0;  ///< largest absolute difference
  ImagePosition where;   ///< of the first maximum in reading order
  bool countsAlpha = false;
};

/// Both of the same size and finite. The same bits for any number of threads.
ImageMetrics compareImages(const Image& test, const Image& reference);

/// The first NaN or infinity in reading order, if there is one. Depth is not looked at.
std::optional<ImagePosition> findNonFinite(const Image& image);

/// Opaque: colour + (1 - alpha) * background, alpha clamped to 0..1 as in writePng. `background` is linear.
Image compositeOver(const Image& image, const glm::vec3& background);

/// |test - reference| of every channel, to look at in an EXR viewer.
Image absoluteDifference(const Image& test, const Image& reference);

}  // namespace freevoxels
