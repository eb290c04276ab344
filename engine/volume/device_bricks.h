#pragma once
// The bricks of a volume's scalars on their way to the device, a batch at a time: what the volume is built
// from.

#include <cstdint>

#include "engine/volume/classification.h"
#include "engine/volume/device_volume.h"
#include "engine/volume/scalar_bricks.h"
#include "engine/vulkan/buffer.h"

namespace freevoxels {

/// Bytes of scalars in a batch, at most.
inline constexpr std::uint64_t kBatchBytes = std::uint64_t(16) << 20;

class DeviceBricks {
 public:
  DeviceBricks(const Device& device, const ScalarBricks& bricks);

  /// One that is empty where there is no brick.
  std::size_t batches() const { return batches_; }
  /// In place of the one before, on which no work may be under way. Waits.
  void upload(std::size_t batch);
  /// What occupied_voxels.comp and pack_voxels.comp do to the batch that was uploaded last.
  shader::BricksPush push(const DeviceVolume& volume, const Classification& classification) const;
  const Buffer& scalars() const { return scalars_; }
  const Buffer& firstVoxels() const { return firstVoxels_; }

 private:
  const Device& device_;
  const ScalarBricks& bricks_;
  std::size_t batches_, bricksPerBatch_, uploaded_;
  std::uint32_t brickCount_ = 0;
  Buffer scalars_;      ///< float
  Buffer firstVoxels_;  ///< ivec3
};

}  // namespace freevoxels
