#pragma once
// Square pictures of a scene from many cameras, to be compared.

#include <vector>

#include "engine/validation/quality_methods.h"
#include "engine/validation/quality_scenes.h"
#include "engine/validation/stage_outputs.h"

namespace freevoxels {

std::vector<Image> oraclePictures(const QualityScene& scene, const std::vector<Camera>& cameras,
                                  glm::ivec2 size);

std::vector<Image> methodPictures(const StageMaker& make, const QualityScene& scene,
                                  const QualityMethod& method, const std::vector<Camera>& cameras,
                                  glm::ivec2 size);

}  // namespace freevoxels
