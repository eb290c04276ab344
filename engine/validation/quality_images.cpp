#include "engine/validation/quality_images.h"

#include "engine/image/metrics.h"
#include "engine/reference/oracle.h"

namespace freevoxels {

Image visibleDifference(const Image& test, const Image& reference) {
  Image difference = absoluteDifference(test, reference);
  for (glm::vec4& pixel : difference.pixels) pixel = glm::vec4(kDifferenceGain * glm::vec3(pixel), 1.0f);
  return difference;
}

std::vector<Image> oracleImages(const QualityScene& scene, const std::vector<Camera>& cameras, glm::ivec2 size) {
  std::vector<Image> images;
  for (const Camera& camera : cameras)
    images.push_back(renderOracle(scene.volume, scene.classification, camera, {.size = size, .tolerance = kQualityTolerance}).image);
  return images;
}

std::vector<Image> methodImages(const StageMaker& make, const QualityScene& scene, const QualityMethod& method,
                                const std::vector<Camera>& cameras, glm::ivec2 size) {
  FrameSettings settings = method.frame;
  settings.size = size;
  Classification classification = scene.classification;
  classification.order = method.order;
  const auto outputs = make(scene.volume, classification, method.table);
  std::vector<Image> images;
  for (const Camera& camera : cameras) images.push_back(outputs->image(camera, settings));
  return images;
}

}  // namespace freevoxels
