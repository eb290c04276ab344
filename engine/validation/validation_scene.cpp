#include "engine/validation/validation_scene.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace freevoxels {

namespace {

std::string sizeText(glm::ivec3 size) {
  return fmt::format("{}x{}x{}", size.x, size.y, size.z);
}

glm::dvec3 centreOfActive(const Volume& volume) {
  glm::dvec3 sum(0.0);
  for (int z = 0; z < volume.dimensions.z; ++z)
    for (int y = 0; y < volume.dimensions.y; ++y)
      for (int x = 0; x < volume.dimensions.x; ++x)
        if (volume.scalar(x, y, z) != kInactiveVoxel) sum += glm::dvec3(x, y, z);
  return sum / double(std::max<std::uint64_t>(volume.activeVoxels, 1));
}

/// Every voxel keeps its place in the world.
Volume cut(const Volume& volume, glm::ivec3 first, glm::ivec3 size) {
  Volume part;
  part.source = volume.source;
  part.dimensions = size;
  part.indexOrigin = volume.indexOrigin + first;
  part.indexToWorld = glm::translate(volume.indexToWorld, glm::dvec3(first));
  part.scalars = ScalarBricks::make(size, [&](glm::ivec3 v) { return volume.scalars.at(first + v); });
  summariseValues(part);
  return part;
}

Classification colourful(const Volume& volume) {
  const auto scalar = [&](float x) { return volume.minimum + x * (volume.maximum - volume.minimum); };
  TransferFunction function{.unitDistance = 4.0 * volume.voxelSize()};
  for (const auto& [x, opacity] :
       {std::pair(0.0f, 0.0f), {0.15f, 0.02f}, {0.4f, 0.3f}, {0.5f, 0.05f}, {0.8f, 0.2f}, {1.0f, 0.9f}})
    function.opacity.push_back({scalar(x), opacity});
  for (const auto& [x, color] : {std::pair(0.0f, glm::vec3(0.1f, 0.3f, 1.0f)),
                                 {0.35f, glm::vec3(0.2f, 0.9f, 0.4f)},
                                 {0.6f, glm::vec3(1.0f, 0.8f, 0.1f)},
                                 {1.0f, glm::vec3(1.0f, 0.2f, 0.1f)}})
    function.color.push_back({scalar(x), color});
  Classification classification;
  classification.transferFunction = function;
  return classification;
}

}  // namespace

ValidationScene makeValidationScene(Volume volume, SceneColor color, int maximumEdge) {
  ValidationScene scene;
  const glm::ivec3 whole = volume.dimensions, size = glm::min(whole, glm::ivec3(maximumEdge));
  if (size != whole) {
    const glm::ivec3 first = glm::ivec3(centreOfActive(volume)) - size / 2;
    volume = cut(volume, glm::clamp(first, glm::ivec3(0), whole - size), size);
  }
  scene.classification =
      color == SceneColor::TransferFunction
          ? colourful(volume)
          : Classification{.densityScale = automaticDensityScale(volume, 2.0), .albedo = {0.9f, 0.6f, 0.3f}};
  if (volume.temperature) {
    Emission emission;
    emission.strength = automaticEmissionStrength(volume, scene.classification, emission);
    scene.classification.emission = emission;
  }
  scene.name = fmt::format("{}, {} voxels{}, {}", volume.source, sizeText(size),
                           size == whole ? "" : " of " + sizeText(whole),
                           color == SceneColor::TransferFunction ? "transfer function" : "density");
  scene.volume = std::move(volume);
  return scene;
}

}  // namespace freevoxels
