#pragma once
// What a volume needs of a device's memory, and whether it has that.

#include <algorithm>
#include <cstdint>
#include <span>

#include "engine/attenuation/directions.h"
#include "engine/volume/device_volume.h"

namespace freevoxels {

/// Bytes.
struct VolumeMemory {
  std::uint64_t occupancy = 0;   ///< two bits for every voxel and block of the box
  std::uint64_t extinction = 0;  ///< of what holds anything, as all that follows
  std::uint64_t table = 0;
  std::uint64_t colors = 0;  ///< only with a transfer function
  std::uint64_t lists = 0;   ///< and of what a frame draws
  std::uint64_t dense = 0;   ///< of all voxels, while the volume is built; half of it for the sweeps

  /// What is kept of the volume, whatever is drawn of it.
  std::uint64_t stored() const { return occupancy + extinction + table + colors; }
  /// The most at any time, without the images, the splats and the sort of a frame.
  std::uint64_t peak() const {
    return occupancy + extinction + colors + lists + std::max(dense, dense / 2 + table);
  }
};

/// `stored` counts the blocks of each level that hold anything (DeviceVolume::stored).
VolumeMemory volumeMemory(const HierarchyLayout& hierarchy, std::span<const std::uint64_t> stored,
                          DirectionSet directions, bool colors);

/// How many voxels the box of a volume may have to be built on this device, were it empty.
std::uint64_t maximumVoxels(const Device& device);

/// Fail with ExitCode::OutOfMemory where the device cannot hold the box; what of it holds anything; its
/// table.
void checkBoxFits(const Device& device, const HierarchyLayout& hierarchy);
void checkStoresFit(const Device& device, const DeviceVolume& volume);
void checkTableFits(const Device& device, const DeviceVolume& volume, DirectionSet directions);

}  // namespace freevoxels
