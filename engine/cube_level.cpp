#include "engine/cube_level.h"

#include <algorithm>
#include <utility>

namespace freevoxels {

CubeLevel::CubeLevel(std::shared_ptr<const VolumeSource> from, int level, const Classification& classification)
    : source{.source = std::move(from), .level = level, .classification = classification},
      onDevice(outlineOnDevice(outline(), classification)) {
  constexpr int kBricks = kCubeEdge / ScalarBricks::kEdge;
  const Cells around = bricksAround(source);
  Cells met((outline().dimensions + kCubeEdge - 1) / kCubeEdge);
  for (glm::ivec3 brick(0); brick.z < around.dimensions.z; ++brick.z)
    for (brick.y = 0; brick.y < around.dimensions.y; ++brick.y)
      for (brick.x = 0; brick.x < around.dimensions.x; ++brick.x) {
        if (around.at(brick) == 0) continue;
        std::uint8_t& isMet = met.values[met.index(brick / kBricks)];
        if (isMet == 0) cubes.push_back(brick / kBricks);
        isMet = 1;
      }
}

void CubeLevel::prepareLights(const Device& device, std::span<const Light> wanted, std::vector<StageTime>& times,
                              const Progress& progress) {
  std::vector<std::unique_ptr<SweptLight>> before = std::exchange(lights, {});
  for (const Light& light : wanted) {
    const RaySource place = lightSource(light, outline().indexToWorld);
    const auto same = std::ranges::find_if(before, [&](const auto& swept) { return swept && swept->source() == place; });
    lights.push_back(same != before.end() ? std::move(*same) : std::make_unique<SweptLight>(device, source, place, times, progress));
  }
}

}  // namespace freevoxels
