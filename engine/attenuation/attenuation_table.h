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
#include "engine/storage/regions.h"

namespace freevoxels {

struct AttenuationTable {
  /// A buffer for each direction, in the order of directions.h, with one byte for each occupied block of all
  /// levels, by rank (device_volume.h), followed by the blocks' bounds. AttenuationSweep fills those of the
  /// voxels.
  std::vector<Buffer> planes;
  std::vector<TexelView> planeTexels;  ///< one byte a texel; empty after pruning
  /// shader::OccupancyWord with a bit for each run of blocks: whether its codes are kept. Empty if all are
  /// (table_pruning.h).
  Buffer keptRuns;
  /// The device addresses of the planes by cellNumber, 0 for cells that are not directions; then that of
  /// `keptRuns`.
  Buffer planeAddresses;
  /// uint by direction, filled with the levels: the code of the voxel with the largest optical depth; for
  /// Linear8 255 minus the code.
  Buffer maxCodePerDirection;
  TableSettings settings;

  /// Writes `planeAddresses`. Blocks until the copy is complete.
  void uploadAddresses(const Device& device) const;
  /// Bytes of device memory of the planes.
  std::uint64_t bytes() const;
};

/// Allocates the table of all levels; checkTableFits() (memory_planner.h) tells beforehand whether it fits.
AttenuationTable makeTable(const Device& device, const DeviceVolume& volume, const TableSettings& settings);

/// The sweep style that is fastest on this kind of device, within the limits of what it can bind.
SweepStyle sweepStyle(const Device& device);

/// The depths where lines enter a part of a volume (storage/regions.h) on the device. Blocks until the copy is complete.
struct DeviceEntryDepths {
  /// `extent` is the part's.
  DeviceEntryDepths(const Device& device, glm::ivec3 extent, const fvx::EntryDepths& depths);
  std::array<std::size_t, fvx::kEntryFaces> first;  ///< of each face in `values`
  Buffer values;                                    ///< float
  /// float: the faces across y of lines that march along z, one after the other, in rows as a slab has them: each depth where its line
  /// was, or would have been, a plane before.
  Buffer sideRows;
};

/// COMPUTE attenuation_sweep.comp, attenuation_sweep_x.comp and, for 98 directions,
/// attenuation_sweep_half.comp: a dispatch for each direction and slab (slabs.h). The dispatches of a slab
/// run concurrently.
class AttenuationSweep {
 public:
  AttenuationSweep(const Device& device, const TableSettings& settings);
  AttenuationSweep(const Device& device, const TableSettings& settings, const SweepStyle& style, bool ofParts = false);
  /// Records the sweeps of a volume. Volumes are swept one after the other, since there is memory for one
  /// slab.
  void record(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table);
  /// Records the sweeps of a part of a volume, which lines enter with these depths. Only for a sweep of parts, with 26 directions and
  /// path-length correction.
  void record(Commands& commands, const DeviceVolume& part, const AttenuationTable& table, const DeviceEntryDepths& entry);

 private:
  void recordSlabs(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table);
  void recordRows(SlabSweep& sweep) const;
  void recordBundles(SlabSweep& sweep, glm::ivec2 yz) const;

  void makeRoom(const SweepPlan& plan, std::uint64_t sideBytes);

  const Device& device_;
  TableSettings settings_;
  SweepStyle style_;
  bool ofParts_;
  const DeviceEntryDepths* entry_ = nullptr;  ///< of the part that is being recorded; its side rows are behind the slab's extinction
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
