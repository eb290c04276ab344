#include "engine/scene/directions.h"

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

/// The axis whose face of the cube contains a point. On an edge or corner it is the first of x, y, z; as the
/// look-up is continuous, the choice does not matter.
int faceAxis(glm::dvec3 point) {
  for (int axis = 0; axis < 2; ++axis)
    if (std::abs(point[axis]) == 1.0) return axis;
  return 2;
}

/// Number of cells inside the cube, which are not directions, with a smaller number than `cell`.
int cellsInsideBefore(DirectionSet set, glm::ivec3 cell) {
  const int k = int(set), edge = 2 * k - 1;
  const auto before = [&](int component) { return std::clamp(component + k - 1, 0, edge); };
  int count = before(cell.z) * edge * edge;
  if (std::abs(cell.z) < k) count += before(cell.y) * edge;
  if (std::abs(cell.z) < k && std::abs(cell.y) < k) count += before(cell.x);
  return count;
}

}  // namespace

DirectionSet directionSetOf(std::size_t count) {
  if (count == std::size_t(directionCount(DirectionSet::Directions98))) return DirectionSet::Directions98;
  FV_CHECK_EQ(count, std::size_t(directionCount(DirectionSet::Directions26)));
  return DirectionSet::Directions26;
}

int directionIndex(DirectionSet set, glm::ivec3 cell) {
  return cellNumber(set, cell) - cellsInsideBefore(set, cell);
}

glm::ivec3 directionCell(DirectionSet set, int index) {
  FV_CHECK_LT(index, directionCount(set));
  const int k = int(set), edge = 2 * k + 1;
  for (int number = index;; ++number) {
    const glm::ivec3 cell(number % edge - k, number / edge % edge - k, number / edge / edge - k);
    const glm::ivec3 size = glm::abs(cell);
    if (std::max({size.x, size.y, size.z}) == k && directionIndex(set, cell) == index) return cell;
  }
}

glm::dvec3 directionAt(DirectionSet set, int index) {
  return glm::dvec3(directionCell(set, index)) / double(set);
}

double stepLength(const glm::dmat4& indexToWorld, glm::dvec3 direction, bool pathLengthCorrection) {
  const glm::dmat3 linear(indexToWorld);
  if (!pathLengthCorrection) return std::cbrt(std::abs(glm::determinant(linear)));
  return glm::length(linear * direction);
}

int encodeOpticalDepth(AttenuationCode code, double opticalDepth) {
  if (code == AttenuationCode::Linear8) return int(std::lround(255.0 * std::exp(-opticalDepth)));
  const double bounded = std::clamp(opticalDepth, 0.0, kMaxCodedDepth);
  return int(std::lround(255.0 * std::sqrt(bounded / kMaxCodedDepth)));
}

double decodeOpticalDepth(AttenuationCode code, int byte) {
  const double unit = byte / 255.0;
  if (code == AttenuationCode::Depth8) return kMaxCodedDepth * unit * unit;
  return byte == 0 ? kOpaqueDepth : -std::log(unit);
}

DirectionBlend bilinearDirections(DirectionSet set, glm::dvec3 direction) {
  const int k = int(set);
  const glm::dvec3 onCube = onUnitCube(direction);
  const glm::dvec3 point = double(k) * onCube;
  const int axis = faceAxis(onCube);
  const int axisA = (axis + 1) % 3;
  const int axisB = (axis + 2) % 3;

  // The quad with corners {lowA, lowA+1} x {lowB, lowB+1}. A point on the line between two quads belongs to
  // the upper one.
  const int lowA = std::min(int(std::floor(point[axisA])), k - 1);
  const int lowB = std::min(int(std::floor(point[axisB])), k - 1);
  const double a = point[axisA] - lowA;
  const double b = point[axisB] - lowB;

  DirectionBlend blend;
  for (int corner = 0; corner < 4; ++corner) {
    const int highA = corner & 1;
    const int highB = corner >> 1;
    glm::ivec3 cell{0};
    cell[axis] = point[axis] < 0.0 ? -k : k;
    cell[axisA] = lowA + highA;
    cell[axisB] = lowB + highB;
    blend.directions[std::size_t(corner)] = directionIndex(set, cell);
    blend.weights[std::size_t(corner)] = (highA ? a : 1.0 - a) * (highB ? b : 1.0 - b);
  }
  return blend;
}

int nearestDirection(DirectionSet set, glm::dvec3 direction) {
  const glm::dvec3 point = double(set) * onUnitCube(direction);
  const auto nearest = [](double x) { return int(std::copysign(std::ceil(std::abs(x) - 0.5), x)); };
  return directionIndex(set, {nearest(point.x), nearest(point.y), nearest(point.z)});
}

}  // namespace freevoxels
