#pragma once
// Volumes with their tables, cameras and frames for tests of the splat sums.

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/reference/reference_splats.h"
#include "engine/reference/reference_table.h"
#include "engine/volume/procedural.h"

namespace freevoxels::test {

/// A volume with its table, ready to draw.
struct Scene {
  Volume volume;
  Classification classification;
  AttenuationCode code = AttenuationCode::Depth8;
  std::vector<double> extinction;
  std::vector<std::uint32_t> voxels;
  std::vector<std::vector<std::uint8_t>> table;

  Scene(Volume v, const Classification& c, AttenuationCode attenuationCode = AttenuationCode::Depth8)
      : volume(std::move(v)), classification(c), code(attenuationCode) {
    extinction = referenceExtinction(volume, classification);
    voxels = referenceVisibleVoxels(extinction);
    table = referenceTable(volume, extinction, {.code = code});
  }
  std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings,
                              const std::vector<std::uint32_t>& list) const {
    return referenceSplatSums(volume, classification,
                              {.extinction = extinction, .table = table, .tableSettings = {.code = code}},
                              camera, settings, list);
  }
  std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) const {
    return sums(camera, settings, voxels);
  }
};

inline Classification physical(double densityScale, glm::vec3 albedo = glm::vec3(1.0f)) {
  Classification classification;
  classification.densityScale = densityScale;
  classification.albedo = albedo;
  return classification;
}

inline FrameSettings frameOf(glm::ivec2 size, Composite composite = Composite::Normalised) {
  FrameSettings settings;
  settings.size = size;
  settings.method = SplatSettings{.composite = composite};
  return settings;
}

/// Looks along -z at (x, y), from z = 20, `height` world units high.
inline Camera lookingDown(double x, double y, double height) {
  Camera camera;
  camera.position = {x, y, 20.0};
  camera.lookAt = {x, y, 0.0};
  camera.orthographic = true;
  camera.orthographicHeight = height;
  return camera;
}

inline glm::dmat4 sheared() {
  glm::dmat4 matrix(1.0);
  matrix[0] = {0.5, 0.1, 0.0, 0.0};
  matrix[1] = {0.4, 0.9, 0.2, 0.0};
  matrix[2] = {-0.3, 0.2, 1.3, 0.0};
  matrix[3] = {2.0, -1.0, 0.5, 1.0};
  return matrix;
}

}  // namespace freevoxels::test
