#include "engine/volume/colors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

constexpr std::size_t kOpacity = 3;

/// Whether all voxels have the same value.
bool isUniform(const ScalarBricks& values) {
  const float first = values.scalarAt(0, 0);
  const auto isOther = [&](float value) { return value != first && value != kInactiveVoxel; };
  for (std::size_t i = 0; i < values.count(); ++i)
    if (std::ranges::any_of(values.brick(i), isOther)) return false;
  return true;
}

}  // namespace

void showColors(Volume& volume, std::vector<ScalarBricks> components, SampleType type) {
  FV_CHECK_LE(kOpacity, components.size());
  const bool isSrgb = type == SampleType::U8, hasOpacity = components.size() > kOpacity && !isUniform(components[kOpacity]);
  const float largest = isSrgb ? 255.0f : 65535.0f;
  ScalarBricks densities = hasOpacity ? std::move(components[kOpacity]) : components[0];
  AlbedoGrid colors{.name = kColorsName, .values = {}};
  for (std::size_t c = 0; c < colors.values.size(); ++c) colors.values[c] = std::move(components[c]);
  std::array<std::span<ScalarBricks::Brick>, 3> colorBricks;
  for (std::size_t c = 0; c < 3; ++c) colorBricks[c] = colors.values[c].editable();
  const std::span<ScalarBricks::Brick> bricks = densities.editable();
  tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t brick) {
    for (std::size_t voxel = 0; voxel < bricks[brick].size(); ++voxel) {
      float& density = bricks[brick][voxel];
      if (density == kInactiveVoxel) continue;
      glm::vec3 color;
      for (int c = 0; c < 3; ++c) {
        float& value = colorBricks[std::size_t(c)][brick][voxel];
        value = isSrgb ? linearFromSrgb(value / largest) : value / largest;
        color[c] = value;
      }
      density = hasOpacity ? density / largest : srgbFromLinear(std::min(glm::dot(color, glm::vec3(kLuminance)), 1.0f));
      if (density <= 0.0f) density = kInactiveVoxel;
    }
  });
  volume.scalars = std::move(densities);
  volume.albedo = std::move(colors);
  volume.isFog = true;
  summariseValues(volume);
}

}  // namespace freevoxels
