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
  /// One byte a direction and block that holds anything, of all levels, by rank (device_volume.h), of which
  /// AttenuationSweep fills the voxels'; then the blocks' bounds. Directions in the order of directions.h.
  std::vector<Buffer> planes;
  std::vector<TexelView> planeTexels;  ///< a byte of a plane a texel; while all codes are kept
  /// shader::OccupancyWord, a bit a run of blocks: whether its codes are kept. Empty where all are
  /// (table_pruning.h).
  Buffer keptRuns;
  /// The planes' device addresses by cellNumber, 0 where a cell is no direction; then that of `keptRuns`.
  Buffer planeAddresses;
  /// uint by direction, once the levels are made: the code of the most opaque voxel; of Linear8 255 minus it.
  Buffer maxCodePerDirection;
  TableSettings settings;

  /// Into `planeAddresses`. Waits.
  void uploadAddresses(const Device& device) const;
  /// What is kept of it.
  std::uint64_t bytes() const;
};

/// Allocates the table of all levels; checkTableFits() (memory_planner.h) tells beforehand whether it fits.
AttenuationTable makeTable(const Device& device, const DeviceVolume& volume, const TableSettings& settings);

/// The sweep style that is fastest on this kind of device, within what it can bind.
SweepStyle sweepStyle(const Device& device);

/// COMPUTE attenuation_sweep.comp, attenuation_sweep_x.comp and, for 98 directions,
/// attenuation_sweep_half.comp: a dispatch a direction and slab (slabs.h), of which those of a slab do not
/// wait for each other.
class AttenuationSweep {
 public:
  AttenuationSweep(const Device& device, const TableSettings& settings);
  AttenuationSweep(const Device& device, const TableSettings& settings, const SweepStyle& style);
  /// One volume after the other: the sweeps have one slab.
  void record(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table);

 private:
  void recordRows(SlabSweep& sweep) const;
  void recordBundles(SlabSweep& sweep, glm::ivec2 yz) const;

  void makeRoom(const SweepPlan& plan);

  const Device& device_;
  TableSettings settings_;
  SweepStyle style_;
  SweepPlan plan_;
  std::array<Pipeline, 3> bundles_;  ///< by the march's step in x, -1, 0, 1
  std::array<Pipeline, 2> rows_;     ///< directions +x and -x
  std::optional<IntermediateSweep> halves_;  ///< of 98 directions
  ExpandPass expand_;
  Buffer extinction_;  ///< float, of all voxels of a slab
  TexelView extinctionQuads_;
  Buffer keptDepths_;  ///< float: of lines between slabs
};

/// Bytes [direction][block] of one level, without padding, 0 of blocks that hold nothing.
std::vector<std::vector<std::uint8_t>> downloadTable(const Device& device, const DeviceVolume& volume,
                                                     const AttenuationTable& table, int level = 0);

/// The same of the bounds of a level above the voxels: what half a byte keeps of the code of each block's
/// most transparent voxel.
std::vector<std::vector<std::uint8_t>> downloadBounds(const Device& device, const DeviceVolume& volume,
                                                      const AttenuationTable& table, int level);

/// By direction, the optical depth of the voxel that has most before it. Of a table that has its levels.
std::vector<double> downloadLargestDepths(const Device& device, const AttenuationTable& table);

}  // namespace freevoxels
