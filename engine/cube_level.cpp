#include "engine/cube_level.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/volume/cell_extinctions.h"
#include "engine/vulkan/commands.h"

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

void CubeLevel::prepareAmbient(const Device& device, const Lighting& lighting, const RaySource& eye, std::vector<StageTime>& times,
                               const Progress& progress) {
  const glm::ivec3 dimensions = outline().dimensions;
  const int edge = ambientCellEdge(dimensions, lighting.phaseG != 0.0);
  FV_CHECK_EQ(kCubeEdge % edge, 0);
  if (!ambient || ambient->edge() != edge) {
    const StageTimer timer(times, "ambient cells");
    ambient.reset();
    const glm::ivec3 cells = (dimensions + edge - 1) / edge;
    std::vector<float> extinctions(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z), 0.0f);
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      if (progress) progress("reading ambient cells", double(i) / double(cubes.size()));
      const VoxelRange cube = cubeVoxels(cubes[i], dimensions);
      const Volume volume = read(cube);
      const std::vector<float> part = cellExtinctions(volume, source.classification, edge);
      const glm::ivec3 size = (cube.extent() + edge - 1) / edge, first = cube.first / edge;
      for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
          std::copy_n(part.begin() + std::ptrdiff_t(size.x * (y + size.y * z)), size.x,
                      extinctions.begin() + std::ptrdiff_t(first.x) +
                          std::ptrdiff_t(cells.x) * (first.y + y + std::ptrdiff_t(cells.y) * (first.z + z)));
    }
    ambient.emplace(device, dimensions, outline().indexToWorld, edge, extinctions);
  }
  try {
    Commands commands(device);
    if (!ambient->record(commands, lighting, eye)) return;
    commands.submitAndWait(progress);
    addTimes(times, commands.times());
  } catch (...) {  // what was swept is not complete
    ambient.reset();
    throw;
  }
}

}  // namespace freevoxels
