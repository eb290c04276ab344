#pragma once
// Boxes to look at, and how much of the image they take.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/camera.h"
#include "engine/volume/procedural.h"

namespace freevoxels::test {

inline Volume box(glm::ivec3 dimensions, const glm::dmat4& indexToWorld) {
  return makeVolume(dimensions, indexToWorld, [](int, int, int) { return 1.0; });
}

/// Rotated, anisotropic, sheared and moved.
inline glm::dmat4 obliqueTransform() {
  glm::dmat4 matrix(1.0);
  matrix[0] = {0.3, 0.1, -0.05, 0.0};
  matrix[1] = {-0.2, 0.5, 0.1, 0.0};
  matrix[2] = {0.1, 0.0, 0.8, 0.0};
  matrix[3] = {4.0, -2.0, 1.0, 1.0};
  return matrix;
}

inline glm::dvec3 transformed(const glm::dmat4& matrix, glm::dvec3 point) {
  const glm::dvec4 h = matrix * glm::dvec4(point, 1.0);
  return glm::dvec3(h) / h.w;
}

/// The largest |x| or |y| in NDC of the 8 corners of the voxels' extent.
inline double largestNdc(const Volume& volume, const Camera& camera, double aspect) {
  double largest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 world = transformed(volume.indexToWorld, side * glm::dvec3(volume.dimensions) - 0.5);
    EXPECT_LT(transformed(worldToCamera(camera), world).z, 0.0) << "behind the eye";
    const glm::dvec3 ndc = transformed(worldToNdc(camera, aspect), world);
    largest = std::max({largest, std::abs(ndc.x), std::abs(ndc.y)});
  }
  return largest;
}

}  // namespace freevoxels::test
