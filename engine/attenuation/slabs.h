#pragma once
// Volumes are swept in slabs of planes along z: only one slab's extinction is there at a time, voxel by
// voxel. Lines that march along z keep their optical depths from slab to slab, and come to the same table bit
// for bit.

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/scene/directions.h"
#include "engine/volume/grid_layout.h"

namespace freevoxels {

/// Slabs begin at multiples of this many planes, where the pattern in which a thread moves along its rows
/// begins anew (line_bundle.glsl), also for steps of two planes.
inline constexpr int kSlabAlignment = 8;

/// Planes `first` to `end` - 1, counted in the order in which its sweeps march.
struct Slab {
  bool upwards = true;  ///< of the sweeps that march towards higher z
  int first = 0, end = 0;

  /// Of the volume, that of the lowest z.
  int lowest(int planes) const { return upwards ? first : planes - end; }
  int count() const { return end - first; }
};

/// How a volume is swept. Bytes are of floats.
struct SweepPlan {
  int planesPerSlab = 0;
  int halo = 0;                 ///< planes beyond either end of a slab that its sweeps look at
  std::uint64_t slabBytes = 0;  ///< a slab's extinction
  std::uint64_t keptBytes = 0;  ///< the depths of lines between slabs; 0 where one slab is all

  std::uint64_t bytes() const { return slabBytes + keptBytes; }
  std::vector<Slab> slabs(int planes) const;
};

/// What is fastest on a kind of device.
struct SweepStyle {
  int voxelsPerThread = 0;
  std::uint64_t slabBytes =
      0;  ///< of a slab's extinction; of planes so large more, for a few planes at least
  std::uint64_t mostSlabBytes = std::numeric_limits<std::uint64_t>::max();  ///< that can be bound
};
SweepStyle sweepStyleOf(bool cpu);

/// In no more than `bytes`, if that is possible at all.
SweepPlan planSweep(const GridLayout& layout, DirectionSet directions, const SweepStyle& style,
                    std::uint64_t bytes);

/// Depths that a thread keeps between slabs, of a march with steps of `stepX` in x.
int linesPerThread(int voxelsPerThread, int stepX);

}  // namespace freevoxels
