#include "engine/validation/stage_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/image/metrics.h"

namespace freevoxels {

namespace {

constexpr float kBrightness = 1e4f;

/// Opaque.
Image brightened(const Image& difference) {
  Image result = difference;
  for (glm::vec4& pixel : result.pixels)
    pixel = glm::vec4(glm::min(kBrightness * glm::vec3(pixel), glm::vec3(1.0f)), 1.0f);
  return result;
}

}  // namespace

Camera cameraInside(const Volume& volume, const Camera& outside) {
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.dimensions - 1) + glm::dvec3(0.1, 0.2, 0.3);
  Camera camera = outside;
  camera.position = glm::dvec3(volume.indexToWorld * glm::dvec4(middle, 1.0));
  camera.lookAt = camera.position + (outside.lookAt - outside.position);
  camera.verticalFov = 60.0;
  return camera;
}

double relativeDifference(double value, double reference) {
  if (value == reference) return 0.0;
  return reference == 0.0 ? std::numeric_limits<double>::infinity() : std::abs(value / reference - 1.0);
}

double largestComponent(glm::dvec3 v) {
  return std::isnan(v.x + v.y + v.z) ? std::numeric_limits<double>::quiet_NaN() : std::max({v.x, v.y, v.z});
}

ImageRow comparedImages(const Image& image, const Image& reference, std::string caption, std::string referenceCaption) {
  return {.caption = std::move(caption),
          .images = {{"device", image},
                     {std::move(referenceCaption), reference},
                     {fmt::format("difference x {:g}", kBrightness), brightened(absoluteDifference(image, reference))}},
          .background = glm::vec3(0.01f)};
}

}  // namespace freevoxels
