#pragma once
// Predicts the device memory that a volume needs at each stage of a frame, checks it before the stage allocates, and decides the
// settings that depend on it.

#include <algorithm>
#include <cstdint>
#include <span>

#include "engine/attenuation/slabs.h"
#include "engine/core/error.h"
#include "engine/octree/device_volume.h"
#include "engine/scene/directions.h"
#include "engine/scene/render_settings.h"

namespace freevoxels {

/// What is stored of occupied blocks besides extinction and table.
struct StoredKinds {
  bool colors = false, emission = false;
};
StoredKinds storedKinds(const DeviceVolume& volume);

/// Bytes of device memory, by purpose.
struct VolumeMemory {
  std::uint64_t occupancy = 0;   ///< two bits for every voxel and block of the box
  std::uint64_t extinction = 0;  ///< of occupied blocks, as are all that follow
  std::uint64_t table = 0;       ///< attenuation table, which only frames make that read it
  std::uint64_t colors = 0;      ///< only with a transfer function or a grid of albedos
  std::uint64_t emission = 0;    ///< only with temperatures
  std::uint64_t lists = 0;       ///< lists of occupied blocks and of the blocks that a frame draws
  std::uint64_t bricks = 0;      ///< a batch of bricks, while the octree is built
  std::uint64_t sweep = 0;       ///< a slab, while the table is swept
  std::uint64_t splats = 0;      ///< a chunk of splat records, while a frame is drawn

  /// Bytes kept for the volume whatever is drawn.
  std::uint64_t stored() const { return occupancy + extinction + table + colors + emission; }
  /// The largest sum at any time, without the images and the sort of a frame.
  std::uint64_t peak() const {
    return occupancy + extinction + colors + emission + lists + std::max(bricks, table + std::max(sweep, splats));
  }
};

/// `stored` counts the occupied blocks of each level (DeviceVolume::stored).
VolumeMemory volumeMemory(const HierarchyLayout& hierarchy, std::span<const std::uint64_t> stored, DirectionSet directions,
                          StoredKinds kinds, const SweepStyle& style);

/// Fails with ErrorKind::OutOfMemory if the device cannot hold or bind the lists of splats, or the attenuation table and a sweep.
void checkSplatsFit(const Device& device, const DeviceVolume& volume);
void checkTableFits(const Device& device, const DeviceVolume& volume, DirectionSet directions);

/// Bytes of device memory that the gather of voxels takes at least. `brickVoxels` are the voxels of all bricks that are not empty;
/// `lighting` is null without lights; `emits` says whether voxels emit light.
std::uint64_t leastGatherBytes(std::uint64_t brickVoxels, glm::ivec3 dimensions, const glm::dmat4& indexToWorld, const Lighting* lighting,
                               bool emits);

/// To be thrown instead of `error`, which a volume or a frame failed with: where the device's memory is limited and is less than
/// frames of splats take at least, a sentence with that, so that a limit has to be raised once only; otherwise `error`.
Error withWholeNeed(const Error& error, const Device& device, const Volume& volume, const Classification& classification,
                    DirectionSet directions, const FrameSettings& settings);

/// The largest number of voxels that an empty volume's box may have on this device.
std::uint64_t maximumVoxels(const Device& device);

/// Whether a volume is certainly larger than a device with these limits (Device::memoryBytes, maximumVoxels) can hold, whatever is drawn of
/// it: it is drawn in pieces or not at all. `activeVoxels` are those of its box with data.
bool exceedsDevice(std::uint64_t deviceBytes, std::uint64_t mostVoxels, glm::ivec3 box, std::uint64_t activeVoxels);

// What the following functions decide depends on all of the device's memory, and not on what is allocated at present, so that it
// is the same for every frame.

/// Resolves LightAttenuation::Auto, for settings with lighting, to lightAttenuationFor, but to Table if exact rays would take more
/// than a quarter of the device's memory or more than `memory` and the images of the frame leave.
LightAttenuation planLightAttenuation(const Device& device, const DeviceVolume& volume, const VolumeMemory& memory,
                                      const FrameSettings& settings);

/// How many bytes the gather's quads may take that a frame does not read, because a turntable returns to them.
std::uint64_t planKeptQuadBytes(const Device& device);

}  // namespace freevoxels
