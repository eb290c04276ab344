// The image as a sum of splats: Subr et al. 2007, Section 4.1, Eq. 10, with footprints that are exact for any
// camera and voxel shape, and the normalised resolve of engine/docs/method.md.

#include "engine/reference/reference_splats.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "engine/core/error.h"
#include "engine/reference/projected_splats.h"
#include "engine/reference/reference_depth.h"
#include "engine/reference/reference_light.h"
#include "engine/volume/scattering_medium.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

namespace {

/// Number of parts of the list that are added up independently, each into its own image, whatever the number
/// of cores.
constexpr std::size_t kParts = 16;

/// Optical depth to the eye at a voxel's centre, and its change per pixel. For a cut kernel: its change per
/// world length along the ray, starting at the centre's distance.
struct DepthToEye {
  double centre = 0.0;
  glm::dvec2 perPixel{0.0};
  double perLength = 0.0, distance = 0.0;

  double at(const CoveredPixel& pixel) const {
    const double along = perLength * (pixel.ahead - distance);
    return std::max(centre + glm::dot(perPixel, pixel.offset) + along, 0.0);
  }
};

/// The integral of (a + b v) exp(-x v) over v from 0 to 1/2.
double halfLayer(double a, double b, double x) {
  if (std::abs(x) < 1e-4) return a * (0.5 - x / 8.0) + b * (1.0 / 8.0 - x / 24.0);
  const double end = std::exp(-0.5 * x);
  return a * (1.0 - end) / x + b * (1.0 - end * (1.0 + 0.5 * x)) / (x * x);
}

double largest(glm::dvec3 light) {
  return std::max({light.r, light.g, light.b});
}

class SplatSummer {
 public:
  SplatSummer(const Volume& volume, const Classification& classification, const SplatInputs& inputs, const Camera& camera,
              const FrameSettings& settings)
      : volume_(volume),
        classification_(classification),
        classifier_(classification, volume),
        inputs_(inputs),
        settings_(settings),
        projector_(volume, camera, settings.size),
        table_(tableFor(camera)),
        codes_(codesFor()) {
    if (settings.lighting) forward_ = splitPhase(*settings.lighting).forward;
    if (forward_ > 0.0) deltaScale_ = deltaScaleOf(*settings.lighting, ScatteringMedium(volume, classification));
    light_ = lightFor();
    FV_CHECK_EQ(inputs.extinction.size(), volume.voxelCount());
  }

  /// Sums over a list, whose items `blockOf` turns into blocks.
  template <typename Item, typename BlockOf>
  std::vector<SplatSums> sum(std::span<const Item> list, const BlockOf& blockOf) const;
  Block voxel(std::uint32_t index) const { return projector_.voxel(index); }

 private:
  std::unique_ptr<ReferenceDepth> tableFor(const Camera& camera) const;
  std::optional<TransferTable> codesFor() const;
  std::unique_ptr<ReferenceLight> lightFor() const;
  void add(const Block& block, std::vector<SplatSums>& image) const;
  double extinctionOf(const Block& block) const {
    return freevoxels::extinctionOf(block, volume_, inputs_.extinction, inputs_.coarser);
  }
  glm::dvec3 emissionOf(const Block& block) const {
    return freevoxels::emissionOf(block, volume_, inputs_.emission, inputs_.coarser);
  }
  glm::dvec3 colorOf(const Block& block) const;
  glm::dvec3 centreOfMass(const Block& block) const;
  DepthToEye depthToEye(const Block& block, const ProjectedSplat& splat, double extinction, int layers) const;
  double extinctionAt(glm::dvec3 position, int axis) const;
  double leaving(const Block& block, const ProjectedSplat& splat, double extinction, double inFront) const;

  const Volume& volume_;
  const Classification& classification_;
  const VoxelClassifier classifier_;
  const SplatInputs& inputs_;
  const FrameSettings& settings_;
  const SplatProjector projector_;
  const std::unique_ptr<ReferenceDepth> table_;
  const std::optional<TransferTable> codes_;     ///< of scalars that are classified after interpolation
  std::unique_ptr<ReferenceLight> light_;        ///< null without lighting
  double forward_ = 0.0;                         ///< PhaseSplit
  glm::dvec3 deltaScale_{1.0};                   ///< mean factor of the extinction of light that this makes
};

std::unique_ptr<ReferenceDepth> SplatSummer::tableFor(const Camera& camera) const {
  const bool inside = eyeIsInside(camera, volume_.dimensions, volume_.indexToWorld);
  return tableDepth(
      volume_, inputs_.extinction, inputs_.table, inputs_.coarser, inputs_.tableSettings, settings_.splats().attenuation,
      [this](glm::dvec3 position) { return projector_.toEye(position); },
      inside ? std::optional(eyeSource(camera, volume_.indexToWorld).place) : std::nullopt, inputs_.emission);
}

std::optional<TransferTable> SplatSummer::codesFor() const {
  if (!classification_.isPost(volume_)) return {};
  return TransferTable(*classification_.transferFunction, volume_.minimum, volume_.maximum);
}

std::unique_ptr<ReferenceLight> SplatSummer::lightFor() const {
  if (!settings_.lighting) return nullptr;
  return std::make_unique<ReferenceLight>(LightInputs{.volume = volume_,
                                                      .extinction = inputs_.extinction,
                                                      .table = inputs_.table,
                                                      .coarser = inputs_.coarser,
                                                      .tableSettings = inputs_.tableSettings,
                                                      .emission = inputs_.emission,
                                                      .scalars = codes_ ? &*codes_ : nullptr,
                                                      .scattered = inputs_.scattered,
                                                      .deltaScale = deltaScale_},
                                          settings_);
}

glm::dvec3 SplatSummer::colorOf(const Block& block) const {
  if (block.level == 0) return classifier_.at(block.cell).color;
  const LevelData& level = inputs_.coarser[std::size_t(block.level) - 1];
  return level.colors.empty() ? glm::dvec3(classification_.albedo) : level.colors[level.at(block.cell)];
}

/// The centre of the extinction, of which every child has its part at its own centre; with emission, the
/// point half-way to the centre of that.
glm::dvec3 SplatSummer::centreOfMass(const Block& block) const {
  if (block.level == 0) return projector_.box(block).centre();
  const double extinction = extinctionOf(block), light = largest(emissionOf(block));
  glm::dvec3 sum(0.0);
  double masses = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Block child{block.level - 1, 2 * block.cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)};
    const BlockBox box = projector_.box(child);
    if (glm::any(glm::lessThanEqual(box.extent, glm::ivec3(0)))) continue;
    double mass = extinction > 0.0 ? extinctionOf(child) / extinction * box.voxels() : 0.0;
    if (light > 0.0) mass += largest(emissionOf(child)) / light * box.voxels();
    sum += mass * box.centre();
    masses += mass;
  }
  return masses > 0.0 ? sum / masses : projector_.box(block).centre();
}

DepthToEye SplatSummer::depthToEye(const Block& block, const ProjectedSplat& splat, double extinction, int layers) const {
  const ReferenceDepth& depths = *table_;
  // The mean depth of a block is that of its middle layer: the layers of the block in front of that are
  // subtracted.
  const double layer = projector_.layerLength(splat), unsaturated = depths.unsaturated(block) * extinction;
  const double before = 0.5 * (layers - 1) * unsaturated * depths.countedLength(layer);
  DepthToEye depth{.centre = std::max(depths.at(block) - before, 0.0)};
  if (!settings_.splats().gradient) return depth;
  if (splat.cut) {
    depth.perLength = extinction;
    depth.distance = projector_.distanceFromEye(splat);
    return depth;
  }
  const glm::dvec3 gradient = depths.gradient(block, splat.toEye, unsaturated * layer);
  // The gradient is reduced with the widening: a widened footprint represents a pixel in which the depth
  // changes several times. The children of a block that is not widened may have been widened.
  const double ofChildren = block.level == 0 ? 1.0 : std::min(splat.edge2 / 4.0, 1.0);
  const double fade = std::pow(splat.widening * ofChildren, 4.0);
  depth.perPixel = fade * glm::dvec2(glm::dot(gradient, splat.pixelX), glm::dot(gradient, splat.pixelY));
  return depth;
}

/// Interpolates between the four voxels around a position in a plane of voxels; 0 outside.
double SplatSummer::extinctionAt(glm::dvec3 position, int axis) const {
  position[axis] = std::round(position[axis]);
  const glm::ivec3 low(glm::floor(position)), n = volume_.dimensions;
  double sum = 0.0;
  for (int z = low.z; z <= low.z + 1; ++z)
    for (int y = low.y; y <= low.y + 1; ++y)
      for (int x = low.x; x <= low.x + 1; ++x) {
        if (x < 0 || y < 0 || z < 0 || x >= n.x || y >= n.y || z >= n.z) continue;
        const glm::dvec3 share = 1.0 - glm::abs(position - glm::dvec3(x, y, z));
        sum += share.x * share.y * share.z * inputs_.extinction[volume_.at(x, y, z)];
      }
  return sum;
}

/// The fraction of a voxel's light that leaves it, relative to that at the front of its layer, averaged over
/// its kernel, a tent along the line of sight.
double SplatSummer::leaving(const Block& block, const ProjectedSplat& splat, double extinction,
                            double inFront) const {
  const int axis = majorAxis(splat.toEye);
  const double layer = projector_.layerLength(splat), own = layer * extinction;
  const glm::dvec3 voxel(block.cell), ahead = splat.toEye / std::abs(splat.toEye[axis]);
  const double before = std::min(layer * extinctionAt(voxel + ahead, axis), inFront);
  const double behind = layer * extinctionAt(voxel - ahead, axis);
  // From the middle of the layer in front to the middle of the layer behind.
  return halfLayer(0.5, -1.0, -before) + halfLayer(0.5, 1.0, own) +
         std::exp(-0.5 * own) * halfLayer(1.0, -1.0, own) + std::exp(-own) * halfLayer(0.5, -1.0, behind);
}

void SplatSummer::add(const Block& block, std::vector<SplatSums>& image) const {
  const std::optional<ProjectedSplat> splat = projector_.project(block, centreOfMass(block));
  if (!splat) return;
  const double sigma = extinctionOf(block);
  const glm::dvec3 albedo = colorOf(block), emission = emissionOf(block);
  const int layers = projector_.box(block).extent[majorAxis(splat->toEye)];
  const DepthToEye depth = depthToEye(block, *splat, sigma, layers);
  const bool ofKernel = settings_.splats().gradient && settings_.splats().composite == Composite::Normalised && block.level == 0;
  const double leaving = ofKernel ? this->leaving(block, *splat, sigma, depth.centre)
                                  : projector_.leaving(*splat, sigma, layers);
  const glm::dvec3 radiance = light_ ? albedo * light_->scattered(block, splat->toEye) : albedo;
  glm::dvec3 deltaFactor(1.0);  // what is scattered forwards goes on to the eye
  for (int c = 0; c < 3 && forward_ > 0.0; ++c)
    deltaFactor[c] = projector_.leaving(*splat, (1.0 - forward_ * albedo[c]) * sigma, layers) / projector_.leaving(*splat, sigma, layers) *
                     std::exp((1.0 - deltaScale_[c]) * depth.centre);
  const auto addTo = [&](const CoveredPixel& pixel) {
    SplatSums& sums = image[pixel.index];
    const double seen = leaving * std::exp(-depth.at(pixel)) * pixel.omega, energy = sigma * seen;
    sums.color += deltaFactor * (energy * radiance + seen * emission);
    sums.energy += energy;
    sums.depth += sigma * pixel.omega;
    sums.distance += energy * splat->distance;
  };
  projector_.forEachPixel(*splat, addTo);
}

template <typename Item, typename BlockOf>
std::vector<SplatSums> SplatSummer::sum(std::span<const Item> list, const BlockOf& blockOf) const {
  using SumImage = std::vector<SplatSums>;
  using Range = tbb::blocked_range<std::size_t>;
  const auto addRange = [&](const Range& range, SumImage image) {
    for (const Item& item : list.subspan(range.begin(), range.size())) add(blockOf(item), image);
    return image;
  };
  const auto join = [](SumImage left, const SumImage& right) {
    for (std::size_t i = 0; i < left.size(); ++i) left[i] += right[i];
    return left;
  };
  const SumImage empty(std::size_t(settings_.size.x) * std::size_t(settings_.size.y));
  const Range all(0, list.size(), std::max<std::size_t>(list.size() / kParts, 1));
  return tbb::parallel_deterministic_reduce(all, empty, addRange, join);
}

}  // namespace

std::vector<SplatSums> referenceSplatSums(const Volume& volume, const Classification& classification,
                                          const SplatInputs& inputs, const Camera& camera,
                                          const FrameSettings& settings,
                                          std::span<const std::uint32_t> voxels) {
  const SplatSummer summer(volume, classification, inputs, camera, settings);
  return summer.sum(voxels, [&](std::uint32_t voxel) {
    FV_CHECK_LT(voxel, volume.voxelCount());
    return summer.voxel(voxel);
  });
}

std::vector<SplatSums> referenceBlockSums(const Volume& volume, const Classification& classification,
                                          const SplatInputs& inputs, const Camera& camera,
                                          const FrameSettings& settings, std::span<const Block> blocks) {
  const SplatSummer summer(volume, classification, inputs, camera, settings);
  return summer.sum(blocks, [&](const Block& block) {
    FV_CHECK_LE(std::size_t(block.level), inputs.coarser.size());
    return block;
  });
}

std::vector<std::uint32_t> referenceVisibleVoxels(const std::vector<double>& extinction,
                                                  std::span<const glm::dvec3> emission) {
  std::vector<std::uint32_t> voxels;
  for (std::size_t i = 0; i < extinction.size(); ++i)
    if (extinction[i] > 0.0 || (!emission.empty() && emission[i] != glm::dvec3(0.0)))
      voxels.push_back(std::uint32_t(i));
  return voxels;
}

Image referenceResolve(const std::vector<SplatSums>& sums, const FrameSettings& settings) {
  FV_CHECK_EQ(sums.size(), std::size_t(settings.size.x) * std::size_t(settings.size.y));
  Image image;
  image.size = settings.size;
  for (const SplatSums& sum : sums) {
    const double opacity = -std::expm1(-sum.depth);
    const bool normalised = settings.splats().composite == Composite::Normalised;
    const double factor = normalised && sum.energy > 0.0 ? opacity / sum.energy : 1.0;
    image.pixels.emplace_back(sum.color * factor, normalised ? opacity : sum.energy);
    if (settings.depth)
      image.depth.push_back(sum.energy > 0.0 ? float(sum.distance / sum.energy)
                                             : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace freevoxels
