#include "engine/streamed_level.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/storage/baked_box.h"
#include "engine/volume/cell_extinctions.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

StreamedLevel::StreamedLevel(std::shared_ptr<const fvx::FvxFile> file, int level, const Classification& classification)
    : baked{.file = std::move(file), .level = level, .classification = classification},
      outline(bakedOutline(*baked.file, level)),
      onDevice(outlineOnDevice(outline, classification)) {
  constexpr int kEdge = kStreamedCubeEdge, kBrick = ScalarBricks::kEdge;
  const glm::ivec3 bricks = (outline.dimensions + kBrick - 1) / kBrick, cells = (outline.dimensions + kEdge - 1) / kEdge;
  const std::vector<std::uint8_t> around = bricksAround(*baked.file, level);
  std::vector<bool> isMet(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z));
  std::size_t i = 0;
  for (glm::ivec3 brick(0); brick.z < bricks.z; ++brick.z)
    for (brick.y = 0; brick.y < bricks.y; ++brick.y)
      for (brick.x = 0; brick.x < bricks.x; ++brick.x, ++i) {
        if (around[i] == 0) continue;
        const glm::ivec3 cell = brick * kBrick / kEdge;
        const auto number = std::size_t(cell.x) + std::size_t(cells.x) * (std::size_t(cell.y) + std::size_t(cells.y) * std::size_t(cell.z));
        if (!isMet[number]) cubes.push_back(cell);
        isMet[number] = true;
      }
}

void StreamedLevel::prepareLights(const Device& device, std::span<const Light> wanted, std::vector<StageTime>& times,
                                  const Progress& progress) {
  std::vector<std::unique_ptr<SweptLight>> before = std::exchange(lights, {});
  for (const Light& light : wanted) {
    const RaySource source = lightSource(light, outline.indexToWorld);
    const auto same = std::ranges::find_if(before, [&](const auto& swept) { return swept && swept->source() == source; });
    lights.push_back(same != before.end() ? std::move(*same) : std::make_unique<SweptLight>(device, baked, source, times, progress));
  }
}

void StreamedLevel::prepareAmbient(const Device& device, const Lighting& lighting, const RaySource& eye, std::vector<StageTime>& times,
                                   const Progress& progress) {
  const glm::ivec3 dimensions = outline.dimensions;
  const int edge = ambientCellEdge(dimensions, lighting.phaseG != 0.0);
  FV_CHECK_EQ(kStreamedCubeEdge % edge, 0);
  if (!ambient || ambient->edge() != edge) {
    const StageTimer timer(times, "ambient cells");
    ambient.reset();
    const glm::ivec3 cells = (dimensions + edge - 1) / edge;
    std::vector<float> extinctions(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z), 0.0f);
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      if (progress) progress("reading ambient cells", double(i) / double(cubes.size()));
      const fvx::VoxelBox cube = cubeVoxels(cubes[i], dimensions);
      const Volume volume = readBakedBox(*baked.file, baked.level, cube);
      const std::vector<float> part = cellExtinctions(volume, baked.classification, edge);
      const glm::ivec3 size = (cube.extent() + edge - 1) / edge, first = cube.first / edge;
      for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
          std::copy_n(part.begin() + std::ptrdiff_t(size.x * (y + size.y * z)), size.x,
                      extinctions.begin() + std::ptrdiff_t(first.x) +
                          std::ptrdiff_t(cells.x) * (first.y + y + std::ptrdiff_t(cells.y) * (first.z + z)));
    }
    ambient.emplace(device, dimensions, outline.indexToWorld, edge, extinctions);
  }
  Commands commands(device);
  if (!ambient->record(commands, lighting, eye)) return;
  commands.submitAndWait(progress);
  addTimes(times, commands.times());
}

}  // namespace freevoxels
