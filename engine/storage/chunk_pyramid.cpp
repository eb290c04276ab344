#include "engine/storage/chunk_pyramid.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace freevoxels::fvx {

namespace {

constexpr int kHalf = kChunkEdge / 2;
constexpr std::size_t kEighthVoxels = std::size_t(kHalf) * kHalf * kHalf;

std::size_t eighthIndex(glm::ivec3 voxel) {
  return std::size_t(voxel.x + kHalf * (voxel.y + kHalf * voxel.z));
}

/// The mean of the voxels of a chunk from `first` to `end` - 1.
float meanOf(const float* values, glm::ivec3 first, glm::ivec3 end, WithoutData withoutData) {
  double sum = 0.0;
  int held = 0, all = 0;
  for (int z = first.z; z < end.z; ++z)
    for (int y = first.y; y < end.y; ++y)
      for (int x = first.x; x < end.x; ++x, ++all)
        if (const float value = values[ChunkValues::index({x, y, z})]; value != kInactiveVoxel) {
          sum += withoutData == WithoutData::Zero ? std::max(value, 0.0f) : value;
          ++held;
        }
  if (held == 0) return kInactiveVoxel;
  return float(sum / (withoutData == WithoutData::Zero ? all : held));
}

}  // namespace

bool ChunkValues::empty() const {
  return std::ranges::all_of(channels, [](const std::vector<float>& values) { return values.empty(); });
}

std::vector<glm::ivec3> levelDimensions(glm::ivec3 dimensions) {
  std::vector<glm::ivec3> levels{dimensions};
  while (std::max({levels.back().x, levels.back().y, levels.back().z}) > kChunkEdge && levels.size() < std::size_t(kMaxLevels))
    levels.push_back((levels.back() + 1) / 2);
  return levels;
}

glm::dmat4 levelToWorld(const glm::dmat4& indexToWorld, int level) {
  const double edge = double(1 << level);
  return indexToWorld * glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(0.5 * (edge - 1.0))), glm::dvec3(edge));
}

ChunkEighth coarser(const ChunkValues& chunk, glm::ivec3 dimensions, WithoutData withoutData) {
  ChunkEighth result{.cell = chunk.cell};
  const glm::ivec3 inside = glm::min(dimensions - chunk.cell * kChunkEdge, kChunkEdge);
  for (std::size_t c = 0; c < chunk.channels.size(); ++c) {
    const std::vector<float>& values = chunk.channels[c];
    const WithoutData rule = Channel(c) == Channel::Scalars ? withoutData : WithoutData::Ignored;
    for (std::size_t component = 0; component < values.size() / kChunkVoxels; ++component)
      for (glm::ivec3 v(0); v.z < kHalf; ++v.z)
        for (v.y = 0; v.y < kHalf; ++v.y)
          for (v.x = 0; v.x < kHalf; ++v.x)
            result.channels[c].push_back(meanOf(&values[component * kChunkVoxels], 2 * v, glm::min(2 * v + 2, inside), rule));
  }
  return result;
}

ChunkPyramid::ChunkPyramid(glm::ivec3 dimensions, WithoutData withoutData, Emit emit)
    : dimensions_(levelDimensions(dimensions)),
      withoutData_(withoutData),
      emit_(std::move(emit)),
      pending_(dimensions_.size()) {}

void ChunkPyramid::add(const ChunkEighth& eighth, std::size_t level) {
  if (level >= pending_.size()) return;
  const glm::ivec3 cell = eighth.cell / 2;
  std::optional<ChunkValues>& parent = pending_[level];
  if (parent && parent->cell != cell) complete(level);
  if (!parent) parent = ChunkValues{.cell = cell};
  const glm::ivec3 first = (eighth.cell - 2 * cell) * kHalf;
  for (std::size_t c = 0; c < eighth.channels.size(); ++c) {
    const std::size_t components = eighth.channels[c].size() / kEighthVoxels;
    std::vector<float>& values = parent->channels[c];
    if (components > 0 && values.empty()) values.assign(components * kChunkVoxels, kInactiveVoxel);
    for (std::size_t component = 0; component < components; ++component)
      for (glm::ivec3 v(0); v.z < kHalf; ++v.z)
        for (v.y = 0; v.y < kHalf; ++v.y)
          for (v.x = 0; v.x < kHalf; ++v.x)
            values[component * kChunkVoxels + ChunkValues::index(first + v)] =
                eighth.channels[c][component * kEighthVoxels + eighthIndex(v)];
  }
}

void ChunkPyramid::complete(std::size_t level) {
  const ChunkValues chunk = *std::exchange(pending_[level], std::nullopt);
  emit_(int(level), chunk);
  add(coarser(chunk, dimensions_[level], withoutData_), level + 1);
}

void ChunkPyramid::finish() {
  for (std::size_t level = 1; level < pending_.size(); ++level)
    if (pending_[level]) complete(level);
}

}  // namespace freevoxels::fvx
