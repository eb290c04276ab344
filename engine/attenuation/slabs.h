#pragma once
// Volumes are swept in slabs of planes along z, of which only one is expanded to a dense grid of extinctions
// at a time. Lines that march along z carry their optical depths from slab to slab, with the same table bit
// for bit.

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/scene/directions.h"
#include "engine/volume/grid_layout.h"

namespace freevoxels {

/// Slabs begin at multiples of this number of planes, at which the pattern in which a thread moves along its
/// rows repeats (line_bundle.glsl), also for steps of two planes.
inline constexpr int kSlabAlignment = 8;

/// Planes `first` to `end` - 1, counted in the direction of the march.
struct Slab {
  bool upwards = true;  ///< whether its sweeps march towards higher z
  int first = 0, end = 0;

  /// The slab's plane of lowest z, counted from the bottom of a volume of `planes` planes.
  int lowest(int planes) const { return upwards ? first : planes - end; }
  int count() const { return end - first; }
};

/// How a volume is swept. Sizes are in bytes.
struct SweepPlan {
  int planesPerSlab = 0;
  int halo = 0;                 ///< planes beyond both ends of a slab that its sweeps read
  std::uint64_t slabBytes = 0;  ///< for the extinction of a slab
  std::uint64_t keptBytes = 0;  ///< for the depths of lines between slabs; 0 if there is only one slab

  std::uint64_t bytes() const { return slabBytes + keptBytes; }
  std::vector<Slab> slabs(int planes) const;
};

/// The parameters that are fastest on a kind of device.
struct SweepStyle {
  int voxelsPerThread = 0;
  bool tiledRows = false;       ///< whether threads that march along x load and store their rows together
  std::uint64_t slabBytes = 0;  ///< preferred bytes of a slab's extinction; more if a few planes need more
  std::uint64_t mostSlabBytes = std::numeric_limits<std::uint64_t>::max();  ///< upper bound of what can be bound
};
SweepStyle sweepStyleOf(bool cpu);

/// Plans a sweep that takes at most `bytes`, if that is possible at all.
SweepPlan planSweep(const GridLayout& layout, DirectionSet directions, const SweepStyle& style,
                    std::uint64_t bytes);

/// Number of depths that a thread carries between slabs, for a march with steps of `stepX` along x.
int linesPerThread(int voxelsPerThread, int stepX);

}  // namespace freevoxels
