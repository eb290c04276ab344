#pragma once
// FLIP of one tile of two pictures: Andersson et al. 2020, sections 4 and 5.

#include <vector>

#include "engine/image/plane_filter.h"

namespace freevoxels {

/// The 2D filters of the paper, each as a sum of products of one along x and one along y.
class FlipFilters {
 public:
  struct Product {
    Kernel rows, columns;
  };

  explicit FlipFilters(double pixelsPerDegree);

  /// Pixels around a tile that its values depend on.
  int margin() const { return margin_; }

  /// The eye's contrast sensitivity to Y, Cx and Cz as low-pass filters (section 4.1.1, Table 1).
  std::vector<Product> contrastSensitivity[3];
  /// Section 4.2: a Gaussian, and its first and second derivatives whose positive and whose negative
  /// weights sum to 1 and -1.
  Kernel gaussian, edge, point;

 private:
  int margin_;
};

/// What a display shows of a picture: a tile and the margin around it, in Y, Cx and Cz.
struct DisplayedTile {
  DisplayedTile(int width, int height) : channels{{width, height}, {width, height}, {width, height}} {}

  /// `color` is linear Rec.709, clamped to 0..1 here.
  void set(int x, int y, const float color[3]);
  bool operator==(const DisplayedTile& other) const;

  Plane channels[3];
};

/// FLIP of the tile without its margins.
Plane flipTile(const DisplayedTile& test, const DisplayedTile& reference, const FlipFilters& filters);

}  // namespace freevoxels
