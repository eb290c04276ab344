#include "engine/image/plane_filter.h"

#include <algorithm>
#include <cstddef>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// The inner loop of all filters, which compilers vectorise.
void addScaled(float* __restrict sum, const float* __restrict values, float weight, int count) {
  for (int i = 0; i < count; ++i) sum[i] += weight * values[i];
}

}  // namespace

void filterRows(const Plane& input, const Kernel& kernel, Plane& output) {
  const int margin = (input.width - output.width) / 2;
  FV_CHECK_EQ(input.height, output.height);
  FV_CHECK_LE(kernel.radius, margin);
  std::ranges::fill(output.values, 0.0f);
  for (int y = 0; y < output.height; ++y)
    for (int k = -kernel.radius; k <= kernel.radius; ++k)
      addScaled(output.row(y), input.row(y) + margin + k, kernel.weights[std::size_t(kernel.radius + k)],
                output.width);
}

void filterColumns(const Plane& input, const Kernel& kernel, Plane& output) {
  std::ranges::fill(output.values, 0.0f);
  addFilteredColumns(input, kernel, output);
}

void addFilteredColumns(const Plane& input, const Kernel& kernel, Plane& output) {
  const int margin = (input.height - output.height) / 2;
  FV_CHECK_EQ(input.width, output.width);
  FV_CHECK_LE(kernel.radius, margin);
  for (int y = 0; y < output.height; ++y)
    for (int k = -kernel.radius; k <= kernel.radius; ++k)
      addScaled(output.row(y), input.row(y + margin + k), kernel.weights[std::size_t(kernel.radius + k)],
                output.width);
}

}  // namespace freevoxels
