#pragma once
// Volumes for the tests of baked files, and their comparison.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/storage/baked_volume.h"
#include "engine/volume/procedural.h"

namespace freevoxels::test {

/// Smooth densities with an empty half, in a box that is no multiple of a chunk or a brick.
inline Volume smoothVolume(glm::ivec3 dimensions = {70, 41, 37}) {
  Volume volume = makeVolume(dimensions, glm::dmat4(glm::dmat3(0.25)), [&](int x, int y, int z) {
    const double wave = std::sin(0.11 * x) + std::sin(0.23 * y + 1.0) + std::cos(0.17 * z);
    return x >= dimensions.x / 2 ? double(kInactiveVoxel) : std::max(wave, 0.0);
  });
  volume.indexToWorld[3] = glm::dvec4(1.0, -2.0, 0.1, 1.0);
  volume.source = "test volume";
  return volume;
}

/// With temperatures in a few bricks, one of them without densities, and albedos.
inline Volume volumeOfAllChannels() {
  Volume volume = smoothVolume();
  const auto grid = [&](auto&& valueAt) { return ScalarBricks::make(volume.dimensions, valueAt); };
  volume.temperature = TemperatureGrid{
      .name = "heat", .values = grid([](glm::ivec3 v) { return v.x > 60 || v.y == 3 ? 1000.0f + float(v.z) : kInactiveVoxel; })};
  summariseValues(*volume.temperature);
  coverBricks(volume, volume.temperature->values);
  volume.albedo = AlbedoGrid{.name = "color", .clippedVoxels = 3};
  for (std::size_t c = 0; c < 3; ++c)
    volume.albedo->values[c] = grid([c](glm::ivec3 v) { return v.z < 20 ? float(c + 1) * 0.2f : kInactiveVoxel; });
  return volume;
}

/// Every voxel, with `tolerance` relative to the larger of a value and `least`.
inline void expectSameVoxels(const ScalarBricks& a, const ScalarBricks& b, double tolerance = 0.0, double least = 1e-3) {
  ASSERT_EQ(a.dimensions(), b.dimensions());
  for (glm::ivec3 v(0); v.z < a.dimensions().z; ++v.z)
    for (v.y = 0; v.y < a.dimensions().y; ++v.y)
      for (v.x = 0; v.x < a.dimensions().x; ++v.x) {
        const float x = a.at(v), y = b.at(v);
        if (tolerance == 0.0 || x == kInactiveVoxel || y == kInactiveVoxel)
          ASSERT_EQ(x, y) << v.x << "," << v.y << "," << v.z;
        else
          ASSERT_NEAR(x, y, tolerance * std::max(double(std::abs(x)), least)) << v.x << "," << v.y << "," << v.z;
      }
}

inline Volume bakedAndRead(const std::filesystem::path& file, const Volume& volume, const Classification& classification,
                           const BakeSettings& settings, int level = 0) {
  bakeVolume(file, volume, classification, settings);
  return readBaked(std::make_shared<const fvx::FvxFile>(file), level);
}

}  // namespace freevoxels::test
