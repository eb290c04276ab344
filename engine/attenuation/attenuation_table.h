#pragma once
// The attenuation table on the device and the sweeps that fill it: Subr et al. 2007, Section 3.1.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/attenuation/intermediate_sweep.h"
#include "engine/attenuation/slabs.h"
#include "engine/octree/device_volume.h"
#include "engine/octree/occupancy.h"
#include "engine/scene/directions.h"
#include "engine/scene/table_settings.h"

namespace freevoxels {

struct AttenuationTable {
  /// A buffer for each direction, in the order of directions.h, with one byte for each occupied block of all
  /// levels, by rank (device_volume.h), followed by the blocks' bounds. AttenuationSweep fills those of the
  /// voxels.
  std::vector<Buffer> planes;
  std::vector<TexelView> planeTexels;  ///< one byte a texel
  /// The device addresses of the planes by cellNumber, 0 for cells that are not directions.
  Buffer planeAddresses;
  /// uint by direction, filled with the levels: the code of the voxel with the largest optical depth; for
  /// Linear8 255 minus the code.
  Buffer maxCodePerDirection;
  TableSettings settings;
};

/// Allocates the table of all levels; checkTableFits() (memory_planner.h) tells beforehand whether it fits.
AttenuationTable makeTable(const Device& device, const DeviceVolume& volume, const TableSettings& settings);

/// The sweep style that is fastest on this kind of device, within the limits of what it can bind.
SweepStyle sweepStyle(const Device& device);

/// COMPUTE attenuation_sweep.comp, attenuation_sweep_x.comp and, for 98 directions,
/// attenuation_sweep_half.comp: a dispatch for each direction and slab (slabs.h). The dispatches of a slab
/// run concurrently.
class AttenuationSweep {
 public:
  AttenuationSweep(const Device& device, const TableSettings& settings);
  AttenuationSweep(const Device& device, const TableSettings& settings, const SweepStyle& style);
  /// Records the sweeps of a volume. Volumes are swept one after the other, since there is memory for one
  /// slab.
  void record(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table);

 private:
  void recordRows(SlabSweep& sweep) const;
  void recordBundles(SlabSweep& sweep, glm::ivec2 yz) const;

  void makeRoom(const SweepPlan& plan);

  const Device& device_;
  TableSettings settings_;
  SweepStyle style_;
  SweepPlan plan_;
  std::array<Pipeline, 3> bundles_;  ///< by the step of the march along x: -1, 0, 1
  std::array<Pipeline, 2> rows_;     ///< directions +x and -x
  std::optional<IntermediateSweep> halves_;  ///< exists for 98 directions
  ExpandPass expand_;
  Buffer extinction_;  ///< float: extinction of all voxels of a slab
  TexelView extinctionQuads_;
  Buffer keptDepths_;  ///< float: optical depths of lines between slabs
};

/// Bytes [direction][block] of a level, without padding; 0 for blocks that are not occupied. Reads back.
std::vector<std::vector<std::uint8_t>> downloadTable(const Device& device, const DeviceVolume& volume,
                                                     const AttenuationTable& table, int level = 0);

/// Bytes [direction][block] of the bounds of a level above the voxels: what half a byte keeps of the code of
/// each block's most transparent voxel. Reads back.
std::vector<std::vector<std::uint8_t>> downloadBounds(const Device& device, const DeviceVolume& volume,
                                                      const AttenuationTable& table, int level);

/// The largest optical depth of any voxel, by direction, of a table with levels. Reads back.
std::vector<double> downloadLargestDepths(const Device& device, const AttenuationTable& table);

}  // namespace freevoxels
