#include "engine/reference/reference_sorted.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "engine/reference/projected_splats.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

namespace {

struct BlendedPixel {
  glm::dvec4 color{0.0};  ///< premultiplied colour and alpha
  double distance = 0.0;  ///< premultiplied by alpha
};

}  // namespace

std::vector<std::uint32_t> referenceBackToFront(const Volume& volume, const Camera& camera,
                                                std::span<const std::uint32_t> voxels) {
  const glm::dvec3 axis = glm::normalize(camera.lookAt - camera.position);
  const auto distance = [&](glm::dvec3 index) {
    const glm::dvec3 toVoxel = glm::dvec3(volume.indexToWorld * glm::dvec4(index, 1.0)) - camera.position;
    return camera.orthographic ? glm::dot(axis, toVoxel) : glm::length(toVoxel);
  };
  const double middle = distance(0.5 * glm::dvec3(volume.dimensions - 1));
  const glm::uvec3 n(volume.dimensions);
  struct Entry {
    float distance;
    std::uint32_t voxel;
  };
  std::vector<Entry> entries;
  for (const std::uint32_t voxel : voxels) {
    const glm::dvec3 index(voxel % n.x, voxel / n.x % n.y, voxel / n.x / n.y);
    entries.push_back({float(distance(index) - middle), voxel});
  }
  std::ranges::stable_sort(entries, std::ranges::greater(), &Entry::distance);
  std::vector<std::uint32_t> sorted;
  for (const Entry& entry : entries) sorted.push_back(entry.voxel);
  return sorted;
}

Image referenceSortedImage(const Volume& volume, const Classification& classification, const Camera& camera, const FrameSettings& settings,
                           std::span<const std::uint32_t> voxels, const ReferenceLight* light) {
  const SplatProjector projector(volume, camera, settings.size);
  std::vector<BlendedPixel> blended(std::size_t(settings.size.x) * std::size_t(settings.size.y));
  const VoxelClassifier classifier(classification, volume);
  for (const std::uint32_t voxel : referenceBackToFront(volume, camera, voxels)) {
    const std::optional<ProjectedSplat> splat = projector.project(projector.voxel(voxel));
    if (!splat) continue;
    const ClassifiedVoxel material = classifier.at(projector.voxel(voxel).cell);
    const double opacity = projector.opacity(*splat, material.extinction);
    const glm::dvec3 sent = projector.leaving(*splat, material.extinction) * material.emission;
    const glm::dvec3 lit = light ? light->scattered(projector.voxel(voxel), splat->toEye) : glm::dvec3(1.0);
    projector.forEachPixel(*splat, [&](const CoveredPixel& pixel) {
      const double whole = opacity * pixel.omega, alpha = std::min(whole, 1.0);
      const glm::dvec3 own = sent * pixel.omega / std::max(whole, 1.0);
      BlendedPixel& behind = blended[pixel.index];
      behind.color = alpha * glm::dvec4(lit * material.color, 1.0) + glm::dvec4(own, 0.0) +
                     (1.0 - alpha) * behind.color;
      behind.distance = alpha * splat->distance + (1.0 - alpha) * behind.distance;
    });
  }
  Image image;
  image.size = settings.size;
  for (const BlendedPixel& pixel : blended) {
    image.pixels.emplace_back(pixel.color);
    if (settings.depth)
      image.depth.push_back(pixel.color.a > 0.0 ? float(pixel.distance / pixel.color.a)
                                                : std::numeric_limits<float>::infinity());
  }
  return image;
}

}  // namespace freevoxels
