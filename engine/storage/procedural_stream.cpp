#include "engine/storage/procedural_stream.h"

#include <algorithm>

#include "engine/octree/hilbert.h"

namespace freevoxels {

namespace {

/// Empty if no voxel is active.
template <typename ValueAt>
std::vector<float> chunkOf(const ProceduralField& field, glm::ivec3 cell, const ValueAt& valueAt) {
  constexpr int n = ScalarBricks::kEdge;
  std::vector<float> values(fvx::kChunkVoxels, kInactiveVoxel);
  for (int brick = 0; brick < fvx::kChunkBricks; ++brick) {
    const glm::ivec3 first = cell * fvx::kChunkEdge + n * fvx::cellInChunk(brick);
    const glm::ivec3 end = glm::min(field.dimensions() - first, n);
    if (std::min({end.x, end.y, end.z}) <= 0 || !field.mayHoldData(first)) continue;
    float* const to = &values[std::size_t(brick) * fvx::kBrickVoxels];
    for (glm::ivec3 v(0); v.z < end.z; ++v.z)
      for (v.y = 0; v.y < end.y; ++v.y)
        for (v.x = 0; v.x < end.x; ++v.x) to[ScalarBricks::indexInBrick(v)] = valueAt(first + v);
  }
  if (std::ranges::all_of(values, [](float value) { return value == kInactiveVoxel; })) values.clear();
  return values;
}

}  // namespace

StreamedVolume proceduralStream(const ProceduralField& field, const Volume& sample, const Classification& classification) {
  StreamedVolume stream{.outline = {.source = sample.source, .dimensions = field.dimensions(), .indexToWorld = field.indexToWorld()},
                        .content = contentCellsOf(field.dimensions(), sample, classification),
                        .range = {sample.minimum, sample.maximum},
                        .cells = hilbertOrder((field.dimensions() + fvx::kChunkEdge - 1) / fvx::kChunkEdge)};
  const bool temperatures = sample.temperature.has_value();
  if (temperatures) stream.outline.temperature.emplace();
  stream.chunk = [&field, temperatures](glm::ivec3 cell) {
    fvx::ChunkValues chunk{.cell = cell};
    chunk.channels[std::size_t(fvx::Channel::Scalars)] = chunkOf(field, cell, [&](glm::ivec3 v) { return field.density(v); });
    if (temperatures)
      chunk.channels[std::size_t(fvx::Channel::Temperature)] =
          chunkOf(field, cell, [&](glm::ivec3 v) { return field.temperature(v); });
    return chunk;
  };
  return stream;
}

}  // namespace freevoxels
