#pragma once
// FLIP: how different two pictures look to somebody who alternates between them, pixel by pixel from 0 (the
// same) to 1.
//   LDR: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild: "FLIP: A Difference Evaluator
//   for
//        Alternating Images", PACM CGIT 3(2), 2020.
//   HDR: Andersson, Nilsson, Shirley, Akenine-Moeller: "Visualizing Errors in Rendered High Dynamic Range
//        Images", Eurographics short papers 2021: the largest LDR-FLIP over a range of exposures.
// Alpha is not looked at: see compositeOver in metrics.h. Pictures must be finite and of the same size.
// The same bits for any number of threads.

#include <numbers>

#include "engine/image/image.h"

namespace freevoxels {

/// On a monitor 0.7 m and 3840 pixels wide, seen from 0.7 m: 0.7 * (3840 / 0.7) * pi / 180 = 67.02.
inline constexpr double kDefaultPixelsPerDegree = 0.7 * (3840.0 / 0.7) * std::numbers::pi / 180.0;

struct FlipMap {
  glm::ivec2 size{0};
  std::vector<float> values;  ///< 0..1, row 0 is the top

  double mean() const;
};

/// Exposure compensations in stops, `count` of them at equal distances from start to stop.
struct Exposures {
  double start = 0.0, stop = 0.0;
  int count = 2;
};

/// Colours are clamped to 0..1, as a display would.
FlipMap ldrFlip(const Image& test, const Image& reference, double pixelsPerDegree = kDefaultPixelsPerDegree);

/// Tone-mapped with the ACES fit that the paper defaults to. Negative colours count as 0.
FlipMap hdrFlip(const Image& test, const Image& reference, const Exposures& exposures,
                double pixelsPerDegree = kDefaultPixelsPerDegree);

/// At least two exposures, at most a stop apart.
Exposures exposuresBetween(double start, double stop);

/// The paper's range: from where the reference's brightest pixel is tone-mapped to 0.85 to where its median
/// is. Luminances below 2^-23 count as 2^-23, which is what the
/// authors' program does: where more than half of the reference is black, it stops at 2^24.
Exposures flipExposures(const Image& reference);

/// The map through matplotlib's magma colours, opaque: black 0, yellow 1.
Image magmaPicture(const FlipMap& map);

}  // namespace freevoxels
