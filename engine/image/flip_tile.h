#pragma once
// FLIP of one tile of two images: Andersson et al. 2020, sections 4 and 5.

#include <vector>

#include "engine/image/plane_filter.h"

namespace freevoxels {

/// The paper's two-dimensional filters, each as a sum of products of a filter along x and one along y.
class FlipFilters {
 public:
  struct Product {
    Kernel rows, columns;
  };

  explicit FlipFilters(double pixelsPerDegree);

  /// Width in pixels of the border around a tile on which its values depend.
  int margin() const { return margin_; }

  /// The eye's contrast sensitivity to Y, Cx and Cz as low-pass filters (section 4.1.1, Table 1).
  std::vector<Product> contrastSensitivity[3];
  /// Section 4.2: a Gaussian, and its first and second derivatives, whose positive weights sum to 1 and
  /// negative weights to -1.
  Kernel gaussian, edge, point;

 private:
  int margin_;
};

/// A displayed tile with its margin, in Y, Cx and Cz.
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
