#include "engine/octree/device_bricks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

using Brick = ScalarBricks::Brick;

/// Largest number of bytes of classified voxels that are kept from one upload of their batch to the next.
constexpr std::uint64_t kMaxKept = std::uint64_t(256) << 20;

static_assert(shader::kMaxExtinction == float(kMaxExtinction));

}  // namespace

DeviceBricks::DeviceBricks(const Device& device, const DeviceVolume& target, const Volume& volume, const Classification& classification)
    : device_(device),
      target_(target),
      volume_(volume),
      classification_(classification),
      bricks_(volume.scalars),
      batches_(std::max<std::size_t>((bricks_.count() * sizeof(Brick) + kBatchBytes - 1) / kBatchBytes, 1)),
      bricksPerBatch_(std::clamp<std::size_t>(bricks_.count(), 1, kBatchBytes / sizeof(Brick))),
      uploaded_(std::numeric_limits<std::size_t>::max()),
      classifier_(classification, volume),
      scalars_(device, bricksPerBatch_ * sizeof(Brick), MemoryUse::Device, "bricks"),
      firstVoxels_(device, bricksPerBatch_ * sizeof(glm::ivec3), MemoryUse::Device, "places of bricks") {
  if (target.hasEmission())
    emissions_ = Buffer(device, scalars_.bytes(), MemoryUse::Device, "emission of bricks");
  if (classification.transferFunction && 2 * batches_ * kBatchBytes <= kMaxKept) kept_.resize(batches_);
  if (target.hasColors) colors_ = Buffer(device, scalars_.bytes(), MemoryUse::Device, "colours of bricks");
}

std::size_t DeviceBricks::sizeOf(std::size_t batch) const {
  return std::min(bricksPerBatch_, bricks_.count() - batch * bricksPerBatch_);
}

/// Uploads a value for each voxel of a batch, 0 beyond the box.
void DeviceBricks::uploadPacked(const Buffer& buffer, std::size_t batch,
                                const std::function<std::uint32_t(glm::ivec3 voxel)>& valueAt) const {
  constexpr int n = ScalarBricks::kEdge;
  constexpr std::size_t size = ScalarBricks::kVoxels;
  std::vector<std::uint32_t> values(sizeOf(batch) * size);
  tbb::parallel_for(std::size_t(0), sizeOf(batch), [&](std::size_t i) {
    const glm::ivec3 first = bricks_.firstVoxel(batch * bricksPerBatch_ + i);
    const glm::ivec3 begin = glm::max(-first, 0), end = glm::min(volume_.dimensions - first, n);
    for (glm::ivec3 v(0, 0, begin.z); v.z < end.z; ++v.z)
      for (v.y = begin.y; v.y < end.y; ++v.y)
        for (v.x = begin.x; v.x < end.x; ++v.x)
          values[i * size + ScalarBricks::indexInBrick(v)] = valueAt(first + v);
  });
  freevoxels::upload(device_, buffer, std::as_bytes(std::span(values)));
}

DeviceBricks::Classified DeviceBricks::classify(std::size_t batch) const {
  constexpr std::size_t size = ScalarBricks::kVoxels;
  const std::size_t values = sizeOf(batch) * size;
  Classified result{.extinctions = std::vector<float>(values), .colors = std::vector<std::uint32_t>(values)};
  tbb::parallel_for(std::size_t(0), sizeOf(batch), [&](std::size_t i) {
    classifier_.classifyBrick(batch * bricksPerBatch_ + i, std::span(result.extinctions).subspan(i * size, size),
                              std::span(result.colors).subspan(i * size, size));
  });
  return result;
}

void DeviceBricks::uploadClassified(std::size_t batch) {
  const auto upload = [&](const Classified& values) {
    freevoxels::upload(device_, scalars_, std::as_bytes(std::span(values.extinctions)));
    freevoxels::upload(device_, colors_, std::as_bytes(std::span(values.colors)));
  };
  if (kept_.empty()) return upload(classify(batch));
  if (kept_[batch].extinctions.empty()) kept_[batch] = classify(batch);
  upload(kept_[batch]);
}

void DeviceBricks::upload(std::size_t batch) {
  if (uploaded_ == batch) return;
  uploaded_ = batch;
  const std::size_t first = batch * bricksPerBatch_, count = sizeOf(batch);
  std::vector<glm::ivec3> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(bricks_.firstVoxel(first + i));
  if (classification_.transferFunction)
    uploadClassified(batch);
  else
    freevoxels::upload(device_, scalars_, count * sizeof(Brick), [&](std::span<std::byte> piece, VkDeviceSize begin) {
      const std::span<Brick> bricks(reinterpret_cast<Brick*>(piece.data()), piece.size() / sizeof(Brick));
      tbb::parallel_for(std::size_t(0), bricks.size(),
                        [&](std::size_t i) { bricks[i] = bricks_.brick(first + begin / sizeof(Brick) + i); });
    });
  freevoxels::upload(device_, firstVoxels_, std::as_bytes(std::span(places)));
  brickCount_ = std::uint32_t(count);
  if (target_.hasEmission())
    uploadPacked(emissions_, batch, [this](glm::ivec3 voxel) {
      return packLight(classifier_.at(voxel).emission / target_.emissionUnit);
    });
  if (target_.hasColors && !classification_.transferFunction)
    uploadPacked(colors_, batch, [this](glm::ivec3 voxel) {
      return packColor(albedoOf(classification_, *volume_.albedo, voxel));
    });
}

shader::BricksPush DeviceBricks::push() const {
  return {.voxels = target_.onDevice(0),
          .stores = target_.stores(),
          .brickCount = brickCount_,
          .densityScale = classification_.transferFunction
                              ? 1.0f
                              : float(std::min(classification_.densityScale, double(std::numeric_limits<float>::max())))};
}

}  // namespace freevoxels
