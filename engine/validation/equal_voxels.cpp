#include "engine/validation/equal_voxels.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/footprint.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

Volume constantVolume(glm::ivec3 dimensions, const glm::dmat4& transform, double value) {
  return makeVolume(dimensions, transform, [&](int, int, int) { return value; });
}

Classification physical(double densityScale, glm::vec3 albedo) {
  return {.densityScale = densityScale, .albedo = albedo};
}

double extinctionOf(double opacity) {
  return -std::log1p(-opacity);
}

Camera lookingDown(double x, double y, double height) {
  return {
      .position = {x, y, 20.0}, .lookAt = {x, y, 0.0}, .orthographic = true, .orthographicHeight = height};
}

double footprintAt(double distance) {
  const double inside = std::max(0.0, 1.0 - distance * distance / (kFootprintRadius * kFootprintRadius));
  return kFootprintPeak * std::pow(inside, 4.0);
}

}  // namespace freevoxels
