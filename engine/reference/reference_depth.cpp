#include "engine/reference/reference_depth.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace freevoxels {

int majorAxis(glm::dvec3 direction) {
  const glm::dvec3 size = glm::abs(direction);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

glm::dvec3 acrossLayer(glm::dvec3 direction) {
  return direction / std::abs(direction[majorAxis(direction)]);
}

ReferenceDepth::ReferenceDepth(const Volume& volume, const std::vector<std::vector<std::uint8_t>>& table,
                               const TableSettings& settings, AttenuationLookup lookup)
    : volume_(volume), table_(table), settings_(settings), lookup_(lookup) {
  FV_CHECK_EQ(table.size(), std::size_t(kDirectionCount));
}

double ReferenceDepth::towards(glm::ivec3 voxel, glm::dvec3 toEye) const {
  const glm::dmat3 toWorld(volume_.indexToWorld);
  const double layer = glm::length(toWorld * acrossLayer(toEye));
  const std::size_t index = volume_.at(voxel.x, voxel.y, voxel.z);
  const auto stored = [&](int direction) {
    const double depth = decodeOpticalDepth(settings_.code, table_[std::size_t(direction)][index]);
    if (!settings_.pathLengthCorrection) return depth;
    return depth * layer / glm::length(toWorld * glm::dvec3(directionAt(direction)));
  };
  if (lookup_ == AttenuationLookup::Nearest) return stored(nearestDirection(toEye));
  const DirectionBlend blend = bilinearDirections(toEye);
  double transmittance = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    transmittance += blend.weights[i] * std::exp(-stored(blend.directions[i]));
  return -std::log(transmittance);
}

}  // namespace freevoxels
