#pragma once
// Procedural volumes and measures that the device tests share.

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "engine/image/image.h"
#include "engine/volume/procedural.h"
#include "tests/image_measures.h"

namespace freevoxels {

/// World cube [-1/2, 1/2]³ along the longest axis, cubic voxels.
inline glm::dmat4 cubeTransform(glm::ivec3 dimensions) {
  const double size = 1.0 / double(std::max({dimensions.x, dimensions.y, dimensions.z}));
  const glm::dmat4 scaled = glm::scale(glm::dmat4(1.0), glm::dvec3(size));
  return glm::translate(scaled, -0.5 * glm::dvec3(dimensions - 1));
}

/// Voxels of different length along x, y and z, and axes that are not at right angles.
inline glm::dmat4 shearedTransform(glm::ivec3 dimensions) {
  glm::dmat4 shear(1.0);
  shear[0] = {0.9, 0.2, 0.0, 0.0};
  shear[1] = {-0.3, 0.6, 0.1, 0.0};
  shear[2] = {0.1, 0.0, 1.4, 0.0};
  return shear * cubeTransform(dimensions);
}

/// `fill` of the voxels hold a random density up to `most`, the rest 0.
inline Volume randomVolume(glm::ivec3 dimensions, const glm::dmat4& transform, double fill, double most,
                           unsigned seed = 7) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return makeVolume(dimensions, transform, [&](int, int, int) {
    const double choice = uniform(generator), density = uniform(generator) * most;
    return choice < fill ? density : 0.0;
  });
}

}  // namespace freevoxels
