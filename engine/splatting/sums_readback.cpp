#include "engine/splatting/sums_readback.h"

namespace freevoxels {

namespace {

/// World length per index length along the pixel's ray: the factor of the footprints that the shaders leave
/// out (splat.frag). `pixel` counts from the middle of the image.
double worldPerIndex(const shader::ResolvePush& rays, glm::dvec2 pixel) {
  const glm::dvec3 index =
      glm::dvec3(rays.ray) + pixel.x * glm::dvec3(rays.rayX) + pixel.y * glm::dvec3(rays.rayY);
  const glm::dvec3 world =
      glm::dvec3(rays.worldRay) + pixel.x * glm::dvec3(rays.worldRayX) + pixel.y * glm::dvec3(rays.worldRayY);
  return glm::length(world) / glm::length(index);
}

}  // namespace

SumsReadback::SumsReadback(const Device& device, Commands& commands, const FrameTargets& targets) {
  colorEnergy_.record(device, commands, targets.colorEnergy);
  opticalDepth_.record(device, commands, targets.opticalDepth);
  if (targets.distance.exists()) distance_.emplace().record(device, commands, targets.distance);
}

std::vector<SplatSums> SumsReadback::read(const FrameConstants& frame) const {
  const auto colorEnergy = colorEnergy_.read<glm::vec4>();
  const auto opticalDepth = opticalDepth_.read<float>();
  const auto distance = distance_ ? distance_->read<float>() : std::vector<float>(opticalDepth.size());
  std::vector<SplatSums> sums(opticalDepth.size());
  const std::size_t width = std::size_t(frame.resolve.size.x);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::dvec2 pixel(double(i % width) + 0.5 - 0.5 * frame.resolve.size.x, double(i / width) + 0.5 - 0.5 * frame.resolve.size.y);
    const double length = worldPerIndex(frame.resolve, pixel);
    sums[i] = {.color = length * glm::dvec3(colorEnergy[i]),
               .energy = length * double(colorEnergy[i].a),
               .depth = length * double(opticalDepth[i]),
               .distance = length * double(distance[i])};
  }
  return sums;
}

}  // namespace freevoxels
