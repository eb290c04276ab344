#pragma once
// Uploads the bricks of a volume batch by batch: scalars, or with a transfer function extinctions; and
// emission and colours if there are any. The octree is built from them.

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/octree/device_volume.h"
#include "engine/volume/classification.h"
#include "engine/volume/scalar_bricks.h"
#include "engine/volume/voxel_classifier.h"
#include "engine/vulkan/buffer.h"

namespace freevoxels {

/// Largest number of bytes of scalars in a batch.
inline constexpr std::uint64_t kBatchBytes = std::uint64_t(16) << 20;

class DeviceBricks {
 public:
  /// The last three arguments must outlive this object.
  DeviceBricks(const Device& device, const DeviceVolume& target, const Volume& volume,
               const Classification& classification);

  /// Number of batches; a volume without bricks has one empty batch.
  std::size_t batches() const { return batches_; }
  /// Uploads a batch, which replaces the one before. No work on that may be in progress. Blocks until the
  /// copy is complete.
  void upload(std::size_t batch);
  /// Push constants of occupied_voxels.comp and pack_voxels.comp for the current batch.
  shader::BricksPush push() const;
  const Buffer& scalars() const { return scalars_; }
  /// Packed emission (packed_light.h) in the order of the scalars; an arbitrary buffer if there is none.
  const Buffer& emissions() const { return target_.hasEmission() ? emissions_ : scalars_; }
  const Buffer& colors() const { return target_.hasColors ? colors_ : scalars_; }
  const Buffer& firstVoxels() const { return firstVoxels_; }

 private:
  /// How many bricks a batch has.
  std::size_t sizeOf(std::size_t batch) const;
  /// Extinctions and packed colours of the voxels of a batch.
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
  std::vector<Classified> kept_;  ///< classified batches, since each is uploaded twice; empty if they would take too much memory
  Buffer scalars_;             ///< float: scalars, or extinctions with a transfer function
  Buffer emissions_, colors_;  ///< uint
  Buffer firstVoxels_;          ///< ivec3
};

}  // namespace freevoxels
