#include "engine/validation/quality_pictures.h"

#include "engine/reference/oracle.h"

namespace freevoxels {

std::vector<Image> oraclePictures(const QualityScene& scene, const std::vector<Camera>& cameras,
                                  glm::ivec2 size) {
  std::vector<Image> pictures;
  for (const Camera& camera : cameras)
    pictures.push_back(renderOracle(scene.volume, scene.classification, camera,
                                    {.size = size, .tolerance = kQualityTolerance})
                           .image);
  return pictures;
}

std::vector<Image> methodPictures(const StageMaker& make, const QualityScene& scene,
                                  const QualityMethod& method, const std::vector<Camera>& cameras,
                                  glm::ivec2 size) {
  FrameSettings settings = method.frame;
  settings.size = size;
  Classification classification = scene.classification;
  classification.order = method.order;
  const auto outputs = make(scene.volume, classification, method.table);
  std::vector<Image> pictures;
  for (const Camera& camera : cameras) pictures.push_back(outputs->picture(camera, settings));
  return pictures;
}

}  // namespace freevoxels
