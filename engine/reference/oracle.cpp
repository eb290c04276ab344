#include "engine/reference/oracle.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "engine/core/error.h"
#include "engine/reference/merged_march.h"
#include "engine/reference/ray_march.h"

namespace freevoxels {

namespace {

constexpr int kFewestSamples = 2;
constexpr int kMaxFirstSamples = 16;

/// The state of a pixel: means over its rays so far.
struct PixelMean {
  glm::dvec4 color{0.0};  ///< premultiplied RGBA
  double distance = 0.0;  ///< sum of e t
  double change = std::numeric_limits<double>::infinity();
};

class Sampler {
 public:
  /// The sum along the ray of a position on the image, in pixels.
  using Ray = std::function<RaySum(glm::dvec2)>;
  Sampler(const OracleSettings& settings, int firstSamples, Ray ray, const Progress& progress)
      : settings_(settings),
        firstSamples_(firstSamples),
        ray_(std::move(ray)),
        progress_(progress),
        pixels_(std::size_t(settings.size.x) * std::size_t(settings.size.y)) {}

  Oracle run();

 private:
  PixelMean sample(std::size_t pixel, int samples) const;
  void sampleAll(const std::vector<std::size_t>& pixels, int samples);
  std::vector<std::size_t> unsettled(const std::vector<std::size_t>& sampled) const;
  Image image() const;

  const OracleSettings& settings_;
  const int firstSamples_;
  const Ray ray_;
  const Progress& progress_;
  std::vector<PixelMean> pixels_;
};

/// The number of rays along an edge of a pixel for which neighbouring rays are at most a voxel apart, at the
/// far end of the volume, where they are farthest apart.
int firstSamplesOf(const Volume& volume, const PixelRays& rays, const OracleSettings& settings) {
  double farthest = 0.0;
  const glm::dmat3 toWorld(volume.indexToWorld);
  const glm::dvec3 middle = rays.direction + 0.5 * settings.size.x * rays.directionX + 0.5 * settings.size.y * rays.directionY;
  const glm::dvec3 axis = toWorld * middle / glm::length(toWorld * middle);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 index = side * glm::dvec3(volume.dimensions + 1) - 1.0;
    farthest = std::max(farthest, glm::dot(toWorld * (index - rays.origin), axis));
  }
  const double apart =
      std::max(glm::length(rays.originX + farthest * rays.directionX), glm::length(rays.originY + farthest * rays.directionY));
  const double wanted = std::clamp(std::ceil(apart), double(kFewestSamples), double(kMaxFirstSamples));
  return std::min(int(std::bit_ceil(unsigned(wanted))), settings.maximumSamples / 2);
}

/// Where the ray of a position on the image ends.
double endOfRay(const OracleSettings& settings, glm::dvec2 at) {
  if (!settings.holdout) return std::numeric_limits<double>::infinity();
  const glm::ivec2 pixel(at);
  return double(settings.holdout->depths[std::size_t(pixel.y) * std::size_t(settings.size.x) + std::size_t(pixel.x)]);
}

PixelMean Sampler::sample(std::size_t pixel, int samples) const {
  const std::size_t width = std::size_t(settings_.size.x);
  const glm::dvec2 corner(double(pixel % width), double(pixel / width));
  PixelMean mean;
  for (int j = 0; j < samples; ++j)
    for (int i = 0; i < samples; ++i) {
      const glm::dvec2 at = corner + (glm::dvec2(i, j) + 0.5) / double(samples);
      const RaySum sum = ray_(at);
      mean.color += glm::dvec4(sum.color, sum.opacity);
      mean.distance += sum.distance;
    }
  const double count = double(samples) * samples;
  mean.color /= count;
  mean.distance /= count;
  return mean;
}

void Sampler::sampleAll(const std::vector<std::size_t>& pixels, int samples) {
  const std::string stage = fmt::format("marching {0}x{0} rays a pixel", samples);
  const std::size_t part = std::max<std::size_t>(pixels.size() / 200, 512);
  for (std::size_t begin = 0; begin < pixels.size(); begin += part) {
    if (progress_) progress_(stage, double(begin) / double(pixels.size()));
    const std::size_t end = std::min(begin + part, pixels.size());
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      PixelMean& pixel = pixels_[pixels[i]];
      const PixelMean before = pixel;
      pixel = sample(pixels[i], samples);
      const glm::dvec4 change = glm::abs(pixel.color - before.color);
      pixel.change = std::max({change.r, change.g, change.b, change.a});
    });
  }
}

/// The pixels to sample again: those that the last doubling changed, and their neighbours, which show the
/// same parts of the volume.
std::vector<std::size_t> Sampler::unsettled(const std::vector<std::size_t>& sampled) const {
  const int width = settings_.size.x, height = settings_.size.y;
  std::vector<bool> wanted(pixels_.size(), false);
  for (const std::size_t pixel : sampled) {
    if (pixels_[pixel].change < settings_.tolerance) continue;
    const int x = int(pixel % std::size_t(width)), y = int(pixel / std::size_t(width));
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
        wanted[std::size_t(j) * std::size_t(width) + std::size_t(i)] = true;
  }
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i]) list.push_back(i);
  return list;
}

Oracle Sampler::run() {
  Oracle oracle;
  std::vector<std::size_t> pixels(pixels_.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = i;
  for (int samples = firstSamples_; samples <= settings_.maximumSamples && !pixels.empty(); samples *= 2) {
    sampleAll(pixels, samples);
    oracle.rays += std::uint64_t(pixels.size()) * std::uint64_t(samples) * std::uint64_t(samples);
    if (oracle.samples > 0) pixels = unsettled(pixels);
    oracle.samples = samples;
  }
  for (const PixelMean& pixel : pixels_) oracle.largestChange = std::max(oracle.largestChange, pixel.change);
  oracle.converged = oracle.largestChange < settings_.tolerance;
  oracle.image = image();
  return oracle;
}

Image Sampler::image() const {
  Image image;
  image.size = settings_.size;
  image.pixels.reserve(pixels_.size());
  for (const PixelMean& pixel : pixels_) {
    image.pixels.emplace_back(pixel.color);
    if (settings_.depth)
      image.depth.push_back(pixel.color.a > 0.0 ? float(pixel.distance / pixel.color.a)
                                                : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace

Oracle renderOracle(const Volume& volume, const Classification& classification, const Camera& camera,
                    const OracleSettings& settings, const Progress& progress) {
  FV_CHECK_LT(0, settings.size.x);
  FV_CHECK_LT(0, settings.size.y);
  FV_CHECK_LT(0.0, settings.step);
  FV_CHECK_LE(2 * kFewestSamples, settings.maximumSamples);
  if (settings.holdout) checkHoldoutSize(*settings.holdout, settings.size);
  const ReferenceField field(volume, classification, progress);
  const PixelRays rays = pixelRays(camera, settings.size, volume.indexToWorld);
  std::unique_ptr<LightMarch> light;  // null without lighting
  if (settings.lighting) light = std::make_unique<LightMarch>(field, volume, classification, *settings.lighting, progress);
  const glm::dmat3 toWorld(volume.indexToWorld);
  const auto sum = [&](glm::dvec2 at) {
    MarchedRay ray;
    ray.origin = rays.origin + at.x * rays.originX + at.y * rays.originY;
    ray.direction = rays.direction + at.x * rays.directionX + at.y * rays.directionY;
    const glm::dvec3 inWorld = toWorld * ray.direction;
    ray.worldLength = glm::length(inWorld);
    ray.worldDirection = inWorld / ray.worldLength;
    ray.distance = settings.depth;
    ray.end = endOfRay(settings, at);
    if (settings.projection != IntensityProjection::None) return projectRay(field, ray, classification, settings.projection);
    return marchRay(field, ray, settings.step, light.get());
  };
  return Sampler(settings, firstSamplesOf(volume, rays, settings), sum, progress).run();
}

Oracle renderOracle(std::span<const PlacedMedium> volumes, const Camera& camera, const OracleSettings& settings, const Progress& progress) {
  if (volumes.size() == 1) return renderOracle(*volumes.front().volume, *volumes.front().classification, camera, settings, progress);
  const MergedMarch march(volumes, settings.lighting, 0.5 * settings.step, progress);
  int samples = 0;
  for (const PlacedMedium& placed : volumes)
    samples = std::max(samples, firstSamplesOf(*placed.volume, pixelRays(camera, settings.size, placed.volume->indexToWorld), settings));
  const PixelRays rays = pixelRays(camera, settings.size, glm::dmat4(1.0));
  const auto sum = [&](glm::dvec2 at) {
    return march.sum({.origin = rays.origin + at.x * rays.originX + at.y * rays.originY,
                      .direction = rays.direction + at.x * rays.directionX + at.y * rays.directionY,
                      .end = endOfRay(settings, at)});
  };
  return Sampler(settings, samples, sum, progress).run();
}

}  // namespace freevoxels
