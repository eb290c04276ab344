#include "engine/cube_level.h"

#include <algorithm>
#include <utility>

#include "engine/attenuation/swept_bricks.h"

namespace freevoxels {

CubeLevel::CubeLevel(std::shared_ptr<const VolumeSource> from, int level, const Classification& classification)
    : source{.source = std::move(from), .level = level, .classification = classification},
      onDevice(outlineOnDevice(outline(), classification)),
      cubes(withNeighbours(source.source->bricks(level)), outline().dimensions) {}

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
