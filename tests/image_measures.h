#pragma once
// How far two images of one size are apart, in premultiplied RGBA: the plain definitions, for tests.

#include <algorithm>
#include <cmath>

#include "engine/image/image.h"

namespace freevoxels {

inline double largestPixelDifference(const Image& a, const Image& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      largest = std::max(largest, double(std::abs(a.pixels[i][c] - b.pixels[i][c])));
  return largest;
}

/// Peak signal-to-noise ratio, in dB for a peak of 1: -20 log10 of the root mean square difference. What tests ask for is, by what the two
/// images may differ in,
///   90 dB, 3e-5: the order and the precision of sums;
///   60 to 70 dB, 1e-3 to 3e-4: stored values that round to another code of 8 or 9 bits in a few voxels;
///   45 dB, 6e-3: less than two codes of an 8-bit image, which is hardly seen, between levels of detail;
///   40 dB, 1e-2: what is approximated in another way.
/// Images that must differ are farther apart than the same bound.
inline double psnr(const Image& a, const Image& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec4 difference = glm::dvec4(a.pixels[i]) - glm::dvec4(b.pixels[i]);
    squares += glm::dot(difference, difference);
  }
  return -10.0 * std::log10(squares / (4.0 * double(a.pixels.size())));
}

/// The largest relative error of the depths where something is seen: alpha above 1e-3 in `expected`.
inline double worstRelativeDepth(const Image& image, const Image& expected) {
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i)
    if (expected.pixels[i].a > 1e-3f) worst = std::max(worst, std::abs(double(image.depth[i]) / double(expected.depth[i]) - 1.0));
  return worst;
}

}  // namespace freevoxels
