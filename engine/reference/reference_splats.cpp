// The picture as a sum of splats: Subr et al. 2007, Section 4.1, Eq. 10, with footprints that are exact for
// any camera and voxel shape, and the normalised resolve of README.md.

#include "engine/reference/reference_splats.h"

#include <cmath>
#include <limits>
#include <optional>

#include "engine/attenuation/directions.h"
#include "engine/core/error.h"
#include "engine/reference/projected_splats.h"
#include "engine/reference/reference_table.h"

namespace freevoxels {

namespace {

class SplatSummer {
 public:
  SplatSummer(const Volume& volume, const Classification& classification, std::span<const double> extinction,
              const std::vector<std::vector<std::uint8_t>>& table, AttenuationCode code, const Camera& camera,
              const FrameSettings& settings)
      : volume_(volume),
        classification_(classification),
        extinction_(extinction),
        table_(table),
        code_(code),
        settings_(settings),
        projector_(volume, camera, settings.size),
        sums_(std::size_t(settings.size.x) * std::size_t(settings.size.y)) {}

  void add(std::uint32_t voxel);
  std::vector<SplatSums> take() { return std::move(sums_); }

 private:
  /// A(v, to eye).
  double transmittance(std::uint32_t voxel, glm::dvec3 toEye) const {
    const auto decode = [&](int direction) {
      return decodeTransmittance(code_, table_[std::size_t(direction)][voxel]);
    };
    if (settings_.attenuation == AttenuationLookup::Nearest) return decode(nearestDirection(toEye));
    const DirectionBlend blend = bilinearDirections(toEye);
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sum += blend.weights[i] * decode(blend.directions[i]);
    return sum;
  }

  const Volume& volume_;
  const Classification& classification_;
  const std::span<const double> extinction_;
  const std::vector<std::vector<std::uint8_t>>& table_;
  const AttenuationCode code_;
  const FrameSettings& settings_;
  const SplatProjector projector_;
  std::vector<SplatSums> sums_;
};

void SplatSummer::add(std::uint32_t voxel) {
  const std::optional<ProjectedSplat> splat = projector_.project(voxel);
  if (!splat) return;
  const double sigma = extinction_[voxel];
  const glm::dvec3 albedo = classify(classification_, volume_.values[voxel]).color;
  const double emitted = transmittance(voxel, splat->toEye) * projector_.opacity(*splat, sigma);
  projector_.forEachPixel(*splat, [&](std::size_t pixel, double omega) {
    SplatSums& sums = sums_[pixel];
    const double energy = emitted * omega;
    sums.color += energy * albedo;
    sums.energy += energy;
    sums.depth += sigma * omega;
    sums.distance += energy * splat->distance;
  });
}

}  // namespace

std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          const std::vector<std::vector<std::uint8_t>>& table,
                                          AttenuationCode code, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels) {
  return referenceSplatSums(volume, classification, referenceExtinction(volume, classification), table, code,
                            camera, settings, voxels);
}

std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          std::span<const double> extinction,
                                          const std::vector<std::vector<std::uint8_t>>& table,
                                          AttenuationCode code, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels) {
  FV_CHECK_EQ(table.size(), std::size_t(kDirectionCount));
  FV_CHECK_EQ(extinction.size(), volume.voxelCount());
  SplatSummer summer(volume, classification, extinction, table, code, camera, settings);
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
