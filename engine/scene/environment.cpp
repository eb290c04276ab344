#include "engine/scene/environment.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/image/image.h"

namespace freevoxels {

namespace {

constexpr std::int64_t kMaxMapPixels = std::int64_t(1) << 27;  // 16384 x 8192
constexpr int kFewestRows = 512;

int partsPerPixel(const Environment& environment) {
  return (kFewestRows + environment.size.y - 1) / environment.size.y;
}

/// Sums over the parts of a row, by direction of a table.
struct RowSums {
  std::vector<glm::dvec3> light;
  std::vector<double> weight;
};

RowSums sumRow(const Environment& environment, int row, DirectionSet set, const glm::dmat3& toIndex) {
  const auto count = std::size_t(directionCount(set));
  RowSums sums{std::vector<glm::dvec3>(count, glm::dvec3(0.0)), std::vector<double>(count, 0.0)};
  for (const EnvironmentPart& part : environmentRow(environment, row)) {
    const DirectionBlend blend = bilinearDirections(set, toIndex * part.direction);
    for (std::size_t k = 0; k < blend.directions.size(); ++k) {
      const auto d = std::size_t(blend.directions[k]);
      const double weight = part.solidAngle * blend.weights[k];
      sums.weight[d] += weight;
      sums.light[d] += weight * part.radiance;
    }
  }
  return sums;
}

}  // namespace

Environment readEnvironment(const std::filesystem::path& file) {
  const Image image = isHdr(file) ? readHdr(file, kMaxMapPixels) : readExr(file, kMaxMapPixels);
  if (image.size.x != 2 * image.size.y)
    fail(ErrorKind::Input,
         "environment '{}' has {}x{} pixels, and a latitude-longitude image is twice as wide as high: choose one",
         file.string(), image.size.x, image.size.y);
  Environment environment{.size = image.size, .radiance = {}};
  environment.radiance.reserve(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec3 pixel(image.pixels[i]);
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(pixel[c]))
        fail(ErrorKind::Input, "environment '{}' holds {} in column {} of row {}, and radiance is finite: repair the image",
             file.string(), pixel[c], i % std::size_t(image.size.x), i / std::size_t(image.size.x));
      if (pixel[c] < 0.0f) ++environment.negativeValues;
    }
    environment.radiance.push_back(glm::max(pixel, 0.0f));
  }
  return environment;
}

int environmentRows(const Environment& environment) {
  return environment.size.y * partsPerPixel(environment);
}

std::vector<EnvironmentPart> environmentRow(const Environment& environment, int row) {
  const int parts = partsPerPixel(environment), rows = environmentRows(environment), columns = 2 * rows;
  const double step = std::numbers::pi / rows;  // angle between rows, and between columns at the equator
  const double polar = (row + 0.5) * step, turned = glm::radians(environment.rotation);
  const double solidAngle = step * (std::cos(row * step) - std::cos((row + 1) * step));
  const std::size_t first = std::size_t(row / parts) * std::size_t(environment.size.x);
  std::vector<EnvironmentPart> result;
  result.reserve(std::size_t(columns));
  for (int column = 0; column < columns; ++column) {
    const double azimuth = std::numbers::pi - (column + 0.5) * step + turned;
    result.push_back({.direction = {std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                    std::sin(polar) * std::cos(azimuth)},
                      .solidAngle = solidAngle,
                      .radiance = environment.intensity *
                                  glm::dvec3(environment.radiance[first + std::size_t(column / parts)])});
  }
  return result;
}

std::vector<glm::dvec3> directionRadiances(const Environment& environment, DirectionSet set,
                                           const glm::dmat4& indexToWorld) {
  const glm::dmat3 toIndex = glm::inverse(glm::dmat3(indexToWorld));
  std::vector<RowSums> rows(std::size_t(environmentRows(environment)));
  tbb::parallel_for(std::size_t(0), rows.size(),
                    [&](std::size_t row) { rows[row] = sumRow(environment, int(row), set, toIndex); });
  std::vector<glm::dvec3> means(std::size_t(directionCount(set)), glm::dvec3(0.0));
  std::vector<double> weights(means.size(), 0.0);
  for (const RowSums& row : rows)
    for (std::size_t d = 0; d < means.size(); ++d) {
      means[d] += row.light[d];
      weights[d] += row.weight[d];
    }
  for (std::size_t d = 0; d < means.size(); ++d) means[d] /= weights[d];
  return means;
}

}  // namespace freevoxels
