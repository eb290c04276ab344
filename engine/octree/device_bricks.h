#pragma once
// The bricks of a volume's scalars, or with a transfer function their extinctions, with light and colours, on their way to the device, a batch at a
// time: what the volume is built from.

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/octree/device_volume.h"
#include "engine/volume/classification.h"
#include "engine/volume/scalar_bricks.h"
#include "engine/volume/voxel_classifier.h"
#include "engine/vulkan/buffer.h"

namespace freevoxels {

/// Bytes of scalars in a batch, at most.
inline constexpr std::uint64_t kBatchBytes = std::uint64_t(16) << 20;

class DeviceBricks {
 public:
  /// Keeps references to the last three.
  DeviceBricks(const Device& device, const DeviceVolume& target, const Volume& volume,
               const Classification& classification);

  /// One that is empty where there is no brick.
  std::size_t batches() const { return batches_; }
  /// In place of the one before, on which no work may be under way. Waits.
  void upload(std::size_t batch);
  /// What occupied_voxels.comp and pack_voxels.comp do to the batch that was uploaded last.
  shader::BricksPush push() const;
  const Buffer& scalars() const { return scalars_; }
  /// packed_light.h, as the scalars; any buffer where there are none.
  const Buffer& emissions() const { return target_.hasEmission() ? emissions_ : scalars_; }
  const Buffer& colors() const { return target_.hasColors ? colors_ : scalars_; }
  const Buffer& firstVoxels() const { return firstVoxels_; }

 private:
  std::span<const ScalarBricks::Brick> batchOf(std::size_t batch) const;
  /// Extinctions and packed colours of a batch.
  struct Classified {
    std::vector<float> extinctions;
    std::vector<std::uint32_t> colors;
  };
  Classified classify(std::size_t batch) const;
  void uploadClassified(std::size_t batch);
  void uploadPacked(const Buffer& buffer, std::size_t batch,
                    const std::function<std::uint32_t(glm::ivec3 voxel)>& valueAt) const;

  const Device& device_;
  const DeviceVolume& target_;
  const Volume& volume_;
  const Classification& classification_;
  const ScalarBricks& bricks_;
  std::size_t batches_, bricksPerBatch_, uploaded_;
  std::uint32_t brickCount_ = 0;
  VoxelClassifier classifier_;
  std::vector<Classified> kept_;  ///< batches are uploaded twice; empty where they would take too much memory
  Buffer scalars_;             ///< float; extinctions with a transfer function
  Buffer emissions_, colors_;  ///< uint
  Buffer firstVoxels_;          ///< ivec3
};

}  // namespace freevoxels
