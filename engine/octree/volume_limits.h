#pragma once
// Whether a device can hold and bind the octree of a volume. All checks fail with ErrorKind::OutOfMemory and a sentence that gives
// the volume's size, what it needs and what the device has.

#include <cstdint>
#include <limits>
#include <string_view>

#include "engine/octree/device_volume.h"

namespace freevoxels {

/// Bytes of the occupancy masks of all levels, which the shaders bind as one buffer of words and as one of texels.
std::uint64_t occupancyBytes(const HierarchyLayout& hierarchy);

/// Bytes of the largest batch of bricks that is on the device while a volume of `box` voxels is built, for each channel.
std::uint64_t brickBytes(glm::ivec3 box);

/// Shaders index voxels with signed 32-bit integers, including the padding of rows.
inline constexpr std::uint64_t kMaxNumberedVoxels = std::numeric_limits<std::int32_t>::max();

/// Fails if the device cannot bind `bytes` in one buffer whose texels have `texelBytes`.
void checkBinds(const Device& device, glm::ivec3 box, std::uint64_t bytes, std::uint64_t texelBytes);

/// Fails if `bytes` exceed the device's memory or the limit set for it; `remedy` ends the sentence.
void checkHolds(const Device& device, glm::ivec3 box, std::uint64_t bytes, std::string_view remedy = "");

/// Fails if the box, were it empty, could not be built: its occupancy and a batch of bricks.
void checkBoxFits(const Device& device, const HierarchyLayout& hierarchy);

/// Fails if the extinction of the occupied blocks cannot be bound.
void checkStoresFit(const Device& device, const DeviceVolume& volume);

}  // namespace freevoxels
