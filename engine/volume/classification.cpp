// Optical model: Max 1995, "Optical models for direct volume rendering". An opacity alpha over the length
// Δ is the extinction -ln(1 - alpha) / Δ.
#include "engine/volume/classification.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/core/error.h"
#include "engine/image/srgb.h"
#include "engine/volume/blackbody.h"

namespace freevoxels {

namespace {

/// Interpolates piecewise linearly, constant beyond the ends. `valueOf(point)` is the interpolated value.
template <typename Points, typename ValueOf>
auto evaluate(const Points& points, double scalar, const ValueOf& valueOf) {
  FV_CHECK_LT(std::size_t(0), points.size());
  const auto above = std::upper_bound(points.begin(), points.end(), scalar,
                                      [](double s, const auto& point) { return s < double(point.scalar); });
  if (above == points.begin()) return valueOf(points.front());
  if (above == points.end()) return valueOf(points.back());
  const auto below = above - 1;
  const double weight = (scalar - below->scalar) / (double(above->scalar) - below->scalar);
  return valueOf(*below) * (1.0 - weight) + valueOf(*above) * weight;
}

ClassifiedVoxel classifyByTransfer(const TransferFunction& transfer, float scalar) {
  using Opacity = TransferFunction::OpacityPoint;
  using Color = TransferFunction::ColorPoint;
  const double opacity =
      evaluate(transfer.opacity, scalar, [](const Opacity& p) { return double(p.opacity); });
  const glm::dvec3 color =
      evaluate(transfer.color, scalar, [](const Color& p) { return glm::dvec3(p.color); });
  return {-std::log1p(-std::min(opacity, kMaxOpacity)) / transfer.unitDistance, color};
}

/// The sum of max(0, density) over the active voxels, in a fixed order, so that every run gives the same
/// number.
double totalDensity(const Volume& volume) {
  using Range = tbb::blocked_range<std::size_t>;
  constexpr std::size_t kGrain = 32;
  return tbb::parallel_deterministic_reduce(
      Range(0, volume.scalars.count(), kGrain), 0.0,
      [&](const Range& range, double sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          for (const float scalar : volume.scalars.brick(i)) sum += std::max(scalar, 0.0f);
        return sum;
      },
      std::plus<>());
}

/// Sums over all voxels of the emitted luminance, its square, and its product with the extinction.
struct LightSums {
  double light = 0.0, squares = 0.0, dimmed = 0.0;
};

LightSums operator+(const LightSums& a, const LightSums& b) {
  return {a.light + b.light, a.squares + b.squares, a.dimmed + b.dimmed};
}

LightSums totalLight(const Volume& volume, const Classification& classification, const Emission& emission) {
  using Range = tbb::blocked_range<std::size_t>;
  constexpr std::size_t kGrain = 32;
  const ScalarBricks& temperatures = volume.temperature->values;
  return tbb::parallel_deterministic_reduce(
      Range(0, temperatures.count(), kGrain), LightSums{},
      [&](const Range& range, LightSums sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const ScalarBricks::Brick values = temperatures.brick(i);
          std::optional<ScalarBricks::Brick> scalars;
          if (const auto brick = volume.scalars.numberAt(temperatures.cell(i))) scalars = volume.scalars.brick(*brick);
          for (std::size_t voxel = 0; voxel < ScalarBricks::kVoxels; ++voxel) {
            const glm::ivec3 place = temperatures.firstVoxel(i) + ScalarBricks::placeInBrick(voxel);
            const glm::dvec3 sent = emittedLight(emission, volume, place, values[voxel]);
            // A channel of light is as bright in blue as in green.
            const double light = volume.temperature->isRadiance ? std::max({sent.r, sent.g, sent.b}) : glm::dot(sent, kLuminance);
            if (light == 0.0) continue;
            const double sigma = scalars ? classify(classification, (*scalars)[voxel]).extinction : 0.0;
            sum = sum + LightSums{light, light * light, light * sigma};
          }
        }
        return sum;
      },
      std::plus<>());
}

}  // namespace

bool Classification::isPost(const Volume& volume) const {
  return transferFunction && order == ClassificationOrder::Post && !(brightestLight(*this, volume) > 0.0);
}

ClassifiedVoxel classify(const Classification& classification, float scalar) {
  if (scalar == kInactiveVoxel) return {};
  ClassifiedVoxel voxel = classification.transferFunction
                              ? classifyByTransfer(*classification.transferFunction, scalar)
                              : ClassifiedVoxel{std::max(double(scalar), 0.0) * classification.densityScale,
                                                glm::dvec3(classification.albedo)};
  voxel.extinction = std::min(voxel.extinction, kMaxExtinction);
  return voxel;
}

glm::dvec3 emittedLight(const Emission& emission, float temperature) {
  if (temperature == kInactiveVoxel) return glm::dvec3(0.0);
  const double kelvin = emission.temperatureScale * double(temperature) + emission.temperatureOffset;
  return glm::min(emission.strength * blackbodyColor(kelvin), glm::dvec3(kMaxExtinction));
}

glm::dvec3 emittedLight(const Emission& emission, const Volume& volume, glm::ivec3 voxel, float value) {
  if (!volume.temperature->isRadiance) return emittedLight(emission, value);
  if (value == kInactiveVoxel) return glm::dvec3(0.0);
  const auto& [red, green, blue] = volume.temperature->colors;
  const glm::dvec3 color(red.at(voxel), green.at(voxel), blue.at(voxel));
  return glm::clamp(emission.strength * double(value) * color, 0.0, kMaxExtinction);
}

double brightestLight(const Emission& emission, const TemperatureGrid& grid, float value) {
  if (grid.isRadiance) return value > 0.0f ? emission.strength * double(value) : 0.0;
  const glm::dvec3 light = emittedLight(emission, value);
  return std::max({light.r, light.g, light.b});
}

double brightestLight(const Classification& classification, const Volume& volume) {
  if (!classification.emission || !volume.temperature || volume.temperature->activeVoxels == 0) return 0.0;
  return brightestLight(*classification.emission, *volume.temperature, volume.temperature->maximum);
}

glm::vec3 albedoOf(const Classification& classification, const AlbedoGrid& grid, glm::ivec3 voxel) {
  const glm::vec3 color(grid.values[0].at(voxel), grid.values[1].at(voxel), grid.values[2].at(voxel));
  return color.r == kInactiveVoxel ? classification.albedo : color;
}

bool areKelvin(const TemperatureGrid& grid) {
  return !(grid.maximum > 0.0f) || double(grid.maximum) > kMinKelvinMaximum;
}

bool areBelowZero(const TemperatureGrid& grid) {
  constexpr float kMinPart = 0.05f;  // of the largest, below which noise may be
  return !areKelvin(grid) && grid.minimum < -kMinPart * grid.maximum;
}

double automaticTemperatureOffset(const TemperatureGrid& grid) {
  return areKelvin(grid) ? 0.0 : kEmberTemperature;
}

double automaticTemperatureScale(const TemperatureGrid& grid, double offset) {
  return areKelvin(grid) ? 1.0 : std::max(kReferenceTemperature - offset, 0.0) / double(grid.maximum);
}

double automaticEmissionStrength(const Volume& volume, const Classification& classification,
                                 const Emission& emission) {
  if (!volume.temperature) return 1.0;
  Emission unit = emission;
  unit.strength = 1.0;
  const LightSums all = totalLight(volume, classification, unit);
  if (!(all.light > 0.0)) return 1.0;
  const double voxels = all.light * all.light / all.squares;
  const double edge = std::cbrt(voxels) * volume.voxelSize();
  const double depth = all.dimmed / all.light * edge;
  const double leaving = depth > 1e-6 ? -std::expm1(-depth) / depth : 1.0;
  const double radiance = volume.temperature->isRadiance ? 1.0 : kAutomaticRadiance;
  return radiance / (all.light / voxels * edge * leaving);
}

double automaticDensityScale(const Volume& volume, double opticalDepth) {
  const double total = totalDensity(volume);  // kInactiveVoxel is negative and adds nothing
  if (!(total > 0.0)) return 1.0;
  const double mean = total / double(volume.activeVoxels);
  const double edge = std::cbrt(double(volume.activeVoxels)) * volume.voxelSize();
  return opticalDepth / (mean * edge);
}

}  // namespace freevoxels
