#include "engine/attenuation/directions.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// The direction scaled onto the surface of the cube [-1,1]³.
glm::dvec3 onUnitCube(glm::dvec3 direction) {
  const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  FV_CHECK_LT(0.0, largest);
  return direction / largest;
}

/// The axis whose face of the cube a point is on. On an edge or corner, the first of x, y, z: the look-up is
/// continuous, so any choice gives the same.
int faceAxis(glm::dvec3 point) {
  for (int axis = 0; axis < 2; ++axis)
    if (std::abs(point[axis]) == 1.0) return axis;
  return 2;
}

}  // namespace

double stepLength(const glm::dmat4& indexToWorld, glm::ivec3 direction, bool pathLengthCorrection) {
  const glm::dmat3 linear(indexToWorld);
  if (!pathLengthCorrection) return std::cbrt(std::abs(glm::determinant(linear)));
  return glm::length(linear * glm::dvec3(direction));
}

int encodeOpticalDepth(AttenuationCode code, double opticalDepth) {
  if (code == AttenuationCode::Linear8) return int(std::lround(255.0 * std::exp(-opticalDepth)));
  const double bounded = std::clamp(opticalDepth, 0.0, kMaximumCodedDepth);
  return int(std::lround(255.0 * std::sqrt(bounded / kMaximumCodedDepth)));
}

double decodeOpticalDepth(AttenuationCode code, int byte) {
  const double unit = byte / 255.0;
  if (code == AttenuationCode::Depth8) return kMaximumCodedDepth * unit * unit;
  return byte == 0 ? kOpaqueDepth : -std::log(unit);
}

DirectionBlend bilinearDirections(glm::dvec3 direction) {
  const glm::dvec3 point = onUnitCube(direction);
  const int axis = faceAxis(point);
  const int axisA = (axis + 1) % 3;
  const int axisB = (axis + 2) % 3;

  // The quad with corners {lowA, lowA+1} x {lowB, lowB+1}; a point on the middle line belongs to the upper
  // one.
  const int lowA = point[axisA] < 0.0 ? -1 : 0;
  const int lowB = point[axisB] < 0.0 ? -1 : 0;
  const double a = point[axisA] - lowA;
  const double b = point[axisB] - lowB;

  DirectionBlend blend;
  for (int corner = 0; corner < 4; ++corner) {
    const int highA = corner & 1;
    const int highB = corner >> 1;
    glm::ivec3 lattice{0};
    lattice[axis] = point[axis] < 0.0 ? -1 : 1;
    lattice[axisA] = lowA + highA;
    lattice[axisB] = lowB + highB;
    blend.directions[std::size_t(corner)] = directionIndex(lattice.x, lattice.y, lattice.z);
    blend.weights[std::size_t(corner)] = (highA ? a : 1.0 - a) * (highB ? b : 1.0 - b);
  }
  return blend;
}

int nearestDirection(glm::dvec3 direction) {
  const glm::dvec3 point = onUnitCube(direction);
  const auto nearest = [](double x) { return x > 0.5 ? 1 : (x < -0.5 ? -1 : 0); };
  return directionIndex(nearest(point.x), nearest(point.y), nearest(point.z));
}

}  // namespace freevoxels
