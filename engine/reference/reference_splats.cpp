// The picture as a sum of splats: Subr et al. 2007, Section 4.1, Eq. 10, with footprints that are exact for
// any camera and voxel shape, and the normalised resolve of README.md.

#include "engine/reference/reference_splats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "engine/core/error.h"
#include "engine/reference/projected_splats.h"
#include "engine/reference/reference_depth.h"
#include "engine/reference/reference_table.h"

namespace freevoxels {

namespace {

/// Optical depth to the eye at a voxel's centre, and its change per pixel; for a kernel that is cut, its
/// change per world length along the ray, from the centre's distance on.
struct DepthToEye {
  double centre = 0.0;
  glm::dvec2 perPixel{0.0};
  double perLength = 0.0, distance = 0.0;

  double at(const CoveredPixel& pixel) const {
    const double along = perLength * (pixel.ahead - distance);
    return std::max(centre + glm::dot(perPixel, pixel.offset) + along, 0.0);
  }
};

class SplatSummer {
 public:
  SplatSummer(const Volume& volume, const Classification& classification, std::span<const double> extinction,
              const std::vector<std::vector<std::uint8_t>>& table, const TableSettings& tableSettings,
              const Camera& camera, const FrameSettings& settings)
      : volume_(volume),
        classification_(classification),
        extinction_(extinction),
        settings_(settings),
        projector_(volume, camera, settings.size),
        depth_(depthFor(table, tableSettings, camera)),
        sums_(std::size_t(settings.size.x) * std::size_t(settings.size.y)) {}

  void add(std::uint32_t voxel);
  std::vector<SplatSums> take() { return std::move(sums_); }

 private:
  std::unique_ptr<ReferenceDepth> depthFor(const std::vector<std::vector<std::uint8_t>>& table,
                                           const TableSettings& tableSettings, const Camera& camera) const;
  DepthToEye depthToEye(std::uint32_t voxel, const ProjectedSplat& splat, double extinction) const;

  const Volume& volume_;
  const Classification& classification_;
  const std::span<const double> extinction_;
  const FrameSettings& settings_;
  const SplatProjector projector_;
  const std::unique_ptr<ReferenceDepth> depth_;
  std::vector<SplatSums> sums_;
};

std::unique_ptr<ReferenceDepth> SplatSummer::depthFor(const std::vector<std::vector<std::uint8_t>>& table,
                                                      const TableSettings& tableSettings,
                                                      const Camera& camera) const {
  const RaySource eye = eyeSource(camera, volume_.indexToWorld);
  const bool inside = eyeIsInside(camera, volume_.dimensions, volume_.indexToWorld);
  const AttenuationLookup lookup = resolveAttenuation(settings_.attenuation, inside);
  if (lookup == AttenuationLookup::Exact) return rayDepth(volume_, extinction_, eye);
  return tableDepth(
      volume_, extinction_, table, tableSettings, lookup,
      [this](glm::dvec3 position) { return projector_.toEye(position); },
      inside ? std::optional(eye.place) : std::nullopt);
}

DepthToEye SplatSummer::depthToEye(std::uint32_t voxel, const ProjectedSplat& splat,
                                   double extinction) const {
  const glm::uvec3 n(volume_.dimensions);
  const glm::ivec3 position(voxel % n.x, voxel / n.x % n.y, voxel / n.x / n.y);
  DepthToEye depth{.centre = depth_->at(position)};
  if (!settings_.gradient) return depth;
  if (splat.cut) {
    depth.perLength = extinction;
    depth.distance = projector_.distanceFromEye(splat);
    return depth;
  }
  const glm::dvec3 gradient =
      depth_->gradient(position, splat.toEye, extinction * projector_.layerLength(splat));
  // It fades with the widening: a widened footprint stands for a pixel in which the depth changes often.
  const double fade = std::pow(splat.amplitude, 4.0);
  depth.perPixel = fade * glm::dvec2(glm::dot(gradient, splat.pixelX), glm::dot(gradient, splat.pixelY));
  return depth;
}

void SplatSummer::add(std::uint32_t voxel) {
  const std::optional<ProjectedSplat> splat = projector_.project(voxel);
  if (!splat) return;
  const double sigma = extinction_[voxel];
  const glm::dvec3 albedo = classify(classification_, volume_.values[voxel]).color;
  const DepthToEye depth = depthToEye(voxel, *splat, sigma);
  const double opacity = projector_.opacity(*splat, sigma);
  projector_.forEachPixel(*splat, [&](const CoveredPixel& pixel) {
    SplatSums& sums = sums_[pixel.index];
    const double energy = opacity * std::exp(-depth.at(pixel)) * pixel.omega;
    sums.color += energy * albedo;
    sums.energy += energy;
    sums.depth += sigma * pixel.omega;
    sums.distance += energy * splat->distance;
  });
}

}  // namespace

std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          const std::vector<std::vector<std::uint8_t>>& table,
                                          const TableSettings& tableSettings, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels) {
  return referenceSplatSums(volume, classification, referenceExtinction(volume, classification), table,
                            tableSettings, camera, settings, voxels);
}

std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          std::span<const double> extinction,
                                          const std::vector<std::vector<std::uint8_t>>& table,
                                          const TableSettings& tableSettings, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels) {
  FV_CHECK_EQ(extinction.size(), volume.voxelCount());
  SplatSummer summer(volume, classification, extinction, table, tableSettings, camera, settings);
  for (const std::uint32_t voxel : voxels) {
    FV_CHECK_LT(voxel, volume.voxelCount());
    summer.add(voxel);
  }
  return summer.take();
}

std::vector<std::uint32_t> referenceVisibleVoxels(const std::vector<double>& extinction) {
  std::vector<std::uint32_t> voxels;
  for (std::size_t i = 0; i < extinction.size(); ++i)
    if (extinction[i] > 0.0) voxels.push_back(std::uint32_t(i));
  return voxels;
}

Image referenceResolve(const std::vector<SplatSums>& sums, const FrameSettings& settings) {
  FV_CHECK_EQ(sums.size(), std::size_t(settings.size.x) * std::size_t(settings.size.y));
  Image image;
  image.size = settings.size;
  for (const SplatSums& sum : sums) {
    const double opacity = -std::expm1(-sum.depth);
    const bool normalised = settings.composite == Composite::Normalised;
    const double factor = normalised && sum.energy > 0.0 ? opacity / sum.energy : 1.0;
    image.pixels.emplace_back(sum.color * factor, normalised ? opacity : sum.energy);
    if (settings.depth)
      image.depth.push_back(sum.energy > 0.0 ? float(sum.distance / sum.energy)
                                             : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace freevoxels
