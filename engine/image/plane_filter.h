#pragma once
// Separable filters over planes of one float a pixel, without borders: the input is larger than the output
// by a margin on every side.

#include <vector>

namespace freevoxels {

struct Plane {
  Plane(int planeWidth, int planeHeight)
      : width(planeWidth), height(planeHeight), values(std::size_t(planeWidth) * std::size_t(planeHeight)) {}

  float* row(int y) { return values.data() + std::size_t(y) * std::size_t(width); }
  const float* row(int y) const { return values.data() + std::size_t(y) * std::size_t(width); }

  int width, height;
  std::vector<float> values;
};

/// weights[radius] is the centre; result(x) = sum over k of weights[radius + k] * input(x + k).
struct Kernel {
  int radius = 0;
  std::vector<float> weights;
};

/// Filters along x. `output` has the input's height and is narrower by twice a margin, which is at least the
/// radius.
void filterRows(const Plane& input, const Kernel& kernel, Plane& output);

/// Filters along y. `output` has the input's width and is lower by twice a margin, which is at least the
/// radius.
void filterColumns(const Plane& input, const Kernel& kernel, Plane& output);

/// Filters along y and adds the result to `output`.
void addFilteredColumns(const Plane& input, const Kernel& kernel, Plane& output);

}  // namespace freevoxels
