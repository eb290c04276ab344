#pragma once
// What a volume needs of a device's memory, and whether it has that.

#include <algorithm>
#include <cstdint>
#include <span>

#include "engine/attenuation/directions.h"
#include "engine/attenuation/slabs.h"
#include "engine/volume/device_volume.h"

namespace freevoxels {

/// What is kept of blocks besides extinction and table.
struct StoredKinds {
  bool colors = false, emission = false;
};
StoredKinds storedKinds(const DeviceVolume& volume);

/// Bytes.
struct VolumeMemory {
  std::uint64_t occupancy = 0;   ///< two bits for every voxel and block of the box
  std::uint64_t extinction = 0;  ///< of what holds anything, as all that follows
  std::uint64_t table = 0;       ///< when it is made
  std::uint64_t unseen = 0;      ///< of that, what is left out afterwards (seen_runs.h)
  std::uint64_t colors = 0;      ///< only with a transfer function or a grid of albedos
  std::uint64_t emission = 0;    ///< only with temperatures
  std::uint64_t lists = 0;       ///< and of what a frame draws
  std::uint64_t bricks = 0;      ///< of a batch, while the volume is built
  std::uint64_t sweep = 0;       ///< of a slab, while the table is made
  std::uint64_t splats = 0;      ///< of a chunk, while a frame is drawn

  /// What is kept of the volume, whatever is drawn of it.
  std::uint64_t stored() const { return occupancy + extinction + table - unseen + colors + emission; }
  /// The most at any time, without the images and the sort of a frame.
  std::uint64_t peak() const {
    return occupancy + extinction + colors + emission + lists +
           std::max(bricks, table + std::max(sweep, splats));
  }
};

/// `stored` counts the blocks of each level that hold anything (DeviceVolume::stored).
VolumeMemory volumeMemory(const HierarchyLayout& hierarchy, std::span<const std::uint64_t> stored,
                          DirectionSet directions, StoredKinds kinds, const SweepStyle& style);

/// What suits the device, as far as it can bind it.
SweepStyle sweepStyle(const Device& device);

/// How many voxels the box of a volume may have to be built on this device, were it empty.
std::uint64_t maximumVoxels(const Device& device);

/// Fail with ExitCode::OutOfMemory where the device, or what is set of it, cannot hold the box; what of it
/// holds anything; its table.
void checkBoxFits(const Device& device, const HierarchyLayout& hierarchy);
void checkStoresFit(const Device& device, const DeviceVolume& volume);
void checkSplatsFit(const Device& device, const DeviceVolume& volume);
void checkTableFits(const Device& device, const DeviceVolume& volume, DirectionSet directions);

}  // namespace freevoxels
