#pragma once
// FLIP: the perceived difference of two images shown in alternation, per pixel from 0 (equal) to 1.
//   LDR: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild: "FLIP: A Difference Evaluator
//   for
//        Alternating Images", PACM CGIT 3(2), 2020.
//   HDR: Andersson, Nilsson, Shirley, Akenine-Moeller: "Visualizing Errors in Rendered High Dynamic Range
//        Images", Eurographics short papers 2021: the largest LDR-FLIP over a range of exposures.
// Alpha is ignored: see compositeOver in metrics.h. Images must be finite and of equal size. The result does
// not depend on the number of threads.

#include <numbers>

#include "engine/image/image.h"

namespace freevoxels {

/// Pixels per degree of a monitor that is 0.7 m and 3840 pixels wide, seen from 0.7 m: 0.7 * (3840 / 0.7) *
/// pi / 180 = 67.02.
inline constexpr double kDefaultPixelsPerDegree = 0.7 * (3840.0 / 0.7) * std::numbers::pi / 180.0;

struct FlipMap {
  glm::ivec2 size{0};
  std::vector<float> values;  ///< 0..1, row 0 is the top

  double mean() const;
};

/// `count` exposure compensations in stops, equally spaced from start to stop.
struct Exposures {
  double start = 0.0, stop = 0.0;
  int count = 2;
};

/// LDR-FLIP. Colours are clamped to 0..1, as by a display.
FlipMap ldrFlip(const Image& test, const Image& reference, double pixelsPerDegree = kDefaultPixelsPerDegree);

/// HDR-FLIP, with the ACES tone mapping that is the paper's default. Negative colours count as 0.
FlipMap hdrFlip(const Image& test, const Image& reference, const Exposures& exposures,
                double pixelsPerDegree = kDefaultPixelsPerDegree);

/// Exposures from `start` to `stop`: at least two, at most one stop apart.
Exposures exposuresBetween(double start, double stop);

/// The paper's exposure range: from the exposure that tone-maps the reference's brightest pixel to 0.85 to
/// the one that does so for its median. Luminances below 2^-23 count as 2^-23, as in the authors' program: if
/// more than half of the reference is black, the range ends at 2^24.
Exposures flipExposures(const Image& reference);

/// The map in matplotlib's colours "magma", opaque: 0 is black, 1 is yellow.
Image magmaImage(const FlipMap& map);

}  // namespace freevoxels
