#include "engine/validation/max_error.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/scene/directions.h"

namespace freevoxels {

std::string voxelText(const Volume& volume, std::size_t voxel) {
  const std::size_t x = std::size_t(volume.dimensions.x), y = std::size_t(volume.dimensions.y);
  return fmt::format("voxel ({}, {}, {})", voxel % x, voxel / x % y, voxel / x / y);
}

std::string directionText(DirectionSet set, int direction) {
  const glm::dvec3 d = directionAt(set, direction);
  return fmt::format("direction ({}, {}, {})", d.x, d.y, d.z);
}

std::string pixelText(glm::ivec2 imageSize, std::size_t pixel) {
  const std::size_t width = std::size_t(imageSize.x);
  return fmt::format("pixel ({}, {})", pixel % width, pixel / width);
}

MaxError largestDifference(const Image& a, const Image& b) {
  FV_CHECK_EQ(a.pixels.size(), b.pixels.size());
  double brightest = 1.0;
  for (const glm::vec4& pixel : b.pixels)
    brightest = std::max({brightest, double(pixel.r), double(pixel.g), double(pixel.b)});
  MaxError worst;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      worst.take(std::abs(double(a.pixels[i][c]) - double(b.pixels[i][c])) / (c < 3 ? brightest : 1.0),
                 [&] { return pixelText(a.size, i); });
  return worst;
}

}  // namespace freevoxels
