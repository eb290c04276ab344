#pragma once
// Procedural volumes and measures that the device tests share.

#include <glm/glm.hpp>
#include <random>

#include "engine/image/image.h"
#include "engine/validation/homogeneous_box.h"
#include "engine/volume/procedural.h"
#include "tests/image_measures.h"

namespace freevoxels {

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

/// Red, green and blue over the scalars 0 to 1, opacity from 0 to `opacity` a voxel.
inline Classification coloured(const Volume& volume, float opacity = 0.9f) {
  Classification classification;
  classification.transferFunction = TransferFunction{
      .opacity = {{0.0f, 0.0f}, {1.0f, opacity}},
      .color = {{0.0f, {1.0f, 0.2f, 0.1f}}, {0.5f, {0.2f, 1.0f, 0.3f}}, {1.0f, {0.1f, 0.3f, 1.0f}}},
      .unitDistance = volume.voxelSize()};
  return classification;
}

}  // namespace freevoxels
