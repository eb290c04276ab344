#include "engine/volume/device_bricks.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace freevoxels {

namespace {

using Brick = ScalarBricks::Brick;

static_assert(shader::kInactiveScalar == kInactiveVoxel);
static_assert(shader::kMaximumOpacity == float(kMaximumOpacity));
static_assert(shader::kMaximumExtinction == float(kMaximumExtinction));

}  // namespace

DeviceBricks::DeviceBricks(const Device& device, const ScalarBricks& bricks)
    : device_(device),
      bricks_(bricks),
      batches_(
          std::max<std::size_t>((bricks.bricks().size() * sizeof(Brick) + kBatchBytes - 1) / kBatchBytes, 1)),
      bricksPerBatch_(std::clamp<std::size_t>(bricks.bricks().size(), 1, kBatchBytes / sizeof(Brick))),
      uploaded_(std::numeric_limits<std::size_t>::max()),
      scalars_(device, bricksPerBatch_ * sizeof(Brick), MemoryUse::Device, "bricks"),
      firstVoxels_(device, bricksPerBatch_ * sizeof(glm::ivec3), MemoryUse::Device, "places of bricks") {}

void DeviceBricks::upload(std::size_t batch) {
  if (uploaded_ == batch) return;
  uploaded_ = batch;
  const std::size_t first = batch * bricksPerBatch_;
  const std::size_t count = std::min(bricksPerBatch_, bricks_.bricks().size() - first);
  std::vector<glm::ivec3> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(bricks_.firstVoxel(first + i));
  freevoxels::upload(device_, scalars_, std::as_bytes(bricks_.bricks().subspan(first, count)));
  freevoxels::upload(device_, firstVoxels_, std::as_bytes(std::span(places)));
  brickCount_ = std::uint32_t(count);
}

shader::BricksPush DeviceBricks::push(const DeviceVolume& volume,
                                      const Classification& classification) const {
  return {.voxels = volume.onDevice(0),
          .brickCount = brickCount_,
          .opacityPoints = volume.opacityPointCount,
          .densityScale = float(std::min(classification.densityScale, kMaximumExtinction)),
          .unitDistance =
              classification.transferFunction ? float(classification.transferFunction->unitDistance) : 1.0f};
}

}  // namespace freevoxels
