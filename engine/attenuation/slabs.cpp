#include "engine/attenuation/slabs.h"

#include <algorithm>
#include <cstdlib>

namespace freevoxels {

namespace {

std::uint64_t planeVoxels(const GridLayout& layout) {
  return std::uint64_t(layout.rowPitch) * std::uint64_t(layout.dimensions.y);
}

/// Least number of planes of a slab. With fewer, carrying depths between slabs costs more than a slab that
/// fits into the cache gains.
constexpr int kFewestPlanes = 32;

/// Planes beyond both ends of a slab that the steps of 98 directions read.
int haloOf(DirectionSet directions) {
  return directions == DirectionSet::Directions98 ? 1 : 0;
}

std::uint64_t slabBytesOf(const GridLayout& layout, DirectionSet directions, int planes) {
  const int all = std::min(planes + 2 * haloOf(directions), layout.dimensions.z);
  // A slab begins and ends with whole occupancy words.
  return (planeVoxels(layout) * std::uint64_t(all) + 2 * shader::kBlocksPerWord) * sizeof(float);
}

/// Bytes of the depths of all directions that march the same way along z. Lines with steps of two planes are
/// of two families.
std::uint64_t keptBytesOf(const GridLayout& layout, DirectionSet set, int voxelsPerThread) {
  std::uint64_t lines = 0;
  for (int i = 0; i < directionCount(set); ++i) {
    const glm::ivec3 cell = directionCell(set, i), step = cell % 2 == glm::ivec3(0) ? cell / 2 : cell;
    if (cell.z > 0) lines += std::uint64_t(std::abs(step.z) * linesPerThread(voxelsPerThread, step.x));
  }
  return planeVoxels(layout) / std::uint64_t(voxelsPerThread) * lines * sizeof(float);
}

}  // namespace

// The voxels of a thread and kExtraLines of line_bundle.glsl.
int linesPerThread(int voxelsPerThread, int stepX) {
  const int size = std::abs(stepX), phases = size == 0 ? 1 : size == 1 ? 4 : 2;
  return voxelsPerThread + size * (phases - 1);
}

SweepStyle sweepStyleOf(bool cpu) {
  // For a CPU: all sweeps of a slab but the first find it in the cache.
  if (cpu) return {.voxelsPerThread = 16, .slabBytes = std::uint64_t(4) << 20};
  return {.voxelsPerThread = 4, .tiledRows = true, .slabBytes = std::uint64_t(256) << 20};
}

SweepPlan planSweep(const GridLayout& layout, DirectionSet directions, const SweepStyle& style,
                    std::uint64_t bytes) {
  const int planes = layout.dimensions.z;
  const std::uint64_t whole = slabBytesOf(layout, directions, planes);
  const std::uint64_t wish = std::min(
      std::max(style.slabBytes, slabBytesOf(layout, directions, kFewestPlanes)), style.mostSlabBytes);
  const SweepPlan oneSlab{.planesPerSlab = planes, .halo = haloOf(directions), .slabBytes = whole};
  if (whole <= std::min(wish, bytes)) return oneSlab;
  const std::uint64_t kept = keptBytesOf(layout, directions, style.voxelsPerThread);
  const std::uint64_t most = std::min(wish, bytes - std::min(bytes, kept));
  int perSlab = kSlabAlignment;
  while (perSlab < planes && slabBytesOf(layout, directions, perSlab + kSlabAlignment) <= most)
    perSlab += kSlabAlignment;
  if (perSlab >= planes) return oneSlab;
  return {.planesPerSlab = perSlab,
          .halo = oneSlab.halo,
          .slabBytes = slabBytesOf(layout, directions, perSlab),
          .keptBytes = kept};
}

std::vector<Slab> SweepPlan::slabs(int planes) const {
  std::vector<Slab> slabs;
  for (const bool upwards : {true, false})
    for (int first = 0; first < planes; first += planesPerSlab)
      slabs.push_back({.upwards = upwards, .first = first, .end = std::min(first + planesPerSlab, planes)});
  return slabs;
}

}  // namespace freevoxels
