#include "engine/scene/scattered_field.h"

#include <algorithm>
#include <cmath>

namespace freevoxels {

glm::dvec3 ScatteredField::at(glm::dvec3 voxel, glm::dvec3 toEye) const {
  const glm::dvec3 place = (voxel + 0.5) / double(edge) - 0.5, low = glm::floor(place), part = place - low;
  glm::dvec3 sum(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 upper(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::ivec3 cell = glm::clamp(glm::ivec3(low) + upper, glm::ivec3(0), cells - 1);
    const glm::dvec3 shares = glm::mix(1.0 - part, part, glm::dvec3(upper));
    const std::size_t i = std::size_t(cell.x) + std::size_t(cells.x) * (std::size_t(cell.y) + std::size_t(cells.y) * std::size_t(cell.z));
    glm::dvec3 light = mean[i];
    for (int axis = 0; axis < 3 && !fluxes.empty(); ++axis) light += flux * toEye[axis] * fluxes[i][std::size_t(axis)];
    sum += shares.x * shares.y * shares.z * light;
  }
  return share * glm::max(sum, 0.0);
}

double ScatteredField::brightest() const {
  double most = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3 along = fluxes.empty() ? glm::dvec3(0.0) : glm::dvec3(fluxes[i][0][c], fluxes[i][1][c], fluxes[i][2][c]);
      most = std::max(most, mean[i][c] + std::abs(flux) * glm::length(along));
    }
  return share * most;
}

}  // namespace freevoxels
