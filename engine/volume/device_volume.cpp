#include "engine/volume/device_volume.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "embedded/classify.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

static_assert(shader::kInactiveScalar == kInactiveVoxel);
static_assert(shader::kMaximumOpacity == float(kMaximumOpacity));
static_assert(shader::kMaximumExtinction == float(kMaximumExtinction));

void copyPadded(const Volume& volume, const GridLayout& layout, std::span<float> target) {
  const std::size_t width = std::size_t(volume.dimensions.x), pitch = std::size_t(layout.rowPitch);
  const std::size_t rows = std::size_t(volume.dimensions.y) * std::size_t(volume.dimensions.z);
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(volume.values.data() + row * width, width, target.data() + row * pitch);
    std::fill_n(target.data() + row * pitch + width, pitch - width, kInactiveVoxel);
  }
  std::ranges::fill(target.subspan(rows * pitch), kInactiveVoxel);
}

void uploadTransferFunction(const Device& device, const Classification& classification,
                            DeviceVolume& target) {
  std::vector<glm::vec4> points;
  if (classification.transferFunction) {
    const TransferFunction& function = *classification.transferFunction;
    for (const auto& point : function.opacity) points.emplace_back(point.scalar, point.opacity, 0.0f, 0.0f);
    for (const auto& point : function.color) points.emplace_back(point.scalar, point.color);
    target.opacityPointCount = std::uint32_t(function.opacity.size());
    target.colorPointCount = std::uint32_t(function.color.size());
  } else {
    points.emplace_back(0.0f);  // a binding needs a buffer
  }
  target.transferPoints =
      Buffer(device, points.size() * sizeof(glm::vec4), MemoryUse::Device, "transfer function");
  upload(device, target.transferPoints, std::as_bytes(std::span(points)));
}

}  // namespace

std::uint64_t DeviceVolume::storedBlocks() const {
  return std::accumulate(stored.begin(), stored.end(), std::uint64_t(0));
}

std::uint32_t DeviceVolume::firstRank(int level) const {
  return std::uint32_t(std::accumulate(stored.begin(), stored.begin() + level, std::uint64_t(0)));
}

shader::BlockLevel DeviceVolume::onDevice(int level) const {
  const GridLayout& grid = hierarchy.levels[std::size_t(level)];
  return {.first = hierarchy.first[std::size_t(level)],
          .firstRank = stored.empty() ? 0 : firstRank(level),
          .rowPitch = grid.rowPitch,
          .dimensions = grid.dimensions};
}

DeviceVolume makeDeviceVolume(const Device& device, const Volume& volume,
                              const Classification& classification) {
  DeviceVolume result{.layout = GridLayout(volume.dimensions),
                      .hierarchy = HierarchyLayout(volume.dimensions),
                      .indexToWorld = volume.indexToWorld,
                      .albedo = classification.albedo,
                      .voxelSize = volume.voxelSize(),
                      .activeVoxels = volume.activeVoxels};
  const std::uint64_t words = result.hierarchy.paddedBlocks() / shader::kBlocksPerWord;
  result.occupancy = Buffer(device, words * sizeof(shader::OccupancyWord), MemoryUse::Device, "occupancy",
                            VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  result.occupancyTexels = TexelView(device, result.occupancy, VK_FORMAT_R32G32_UINT);
  uploadTransferFunction(device, classification, result);
  return result;
}

DenseVoxels uploadVoxels(const Device& device, const Volume& volume, const HierarchyLayout& hierarchy) {
  const std::uint64_t count = hierarchy.denseVoxels();
  DenseVoxels voxels;
  voxels.scalars = Buffer(device, count * sizeof(float), MemoryUse::Device, "all scalars");
  voxels.extinction = Buffer(device, count * sizeof(float), MemoryUse::Device, "all extinction",
                             VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  voxels.extinctionQuads = TexelView(device, voxels.extinction);
  const GridLayout& layout = hierarchy.levels.front();
  if (voxels.scalars.mapped() != nullptr) {
    copyPadded(volume, layout, {reinterpret_cast<float*>(voxels.scalars.mapped()), count});
    return voxels;
  }
  std::vector<float> padded(count);
  copyPadded(volume, layout, padded);
  upload(device, voxels.scalars, std::as_bytes(std::span(padded)));
  return voxels;
}

ClassifyPass::ClassifyPass(const Device& device)
    : pipeline_(makeComputePipeline(device, {classify_spv, "classify"},
                                    {.bindings = std::vector(3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                                     .pushConstantBytes = sizeof(shader::ClassifyPush)},
                                    {shader::kClassifyThreads, 1, 1})) {}

void ClassifyPass::record(Commands& commands, const DeviceVolume& volume, const DenseVoxels& voxels,
                          const Classification& classification) const {
  const std::uint64_t quads = volume.hierarchy.denseVoxels() / 4;
  const shader::ClassifyPush push{
      .quadCount = std::uint32_t(quads),
      .opacityPoints = volume.opacityPointCount,
      .densityScale = float(std::min(classification.densityScale, kMaximumExtinction)),
      .unitDistance =
          classification.transferFunction ? float(classification.transferFunction->unitDistance) : 1.0f};
  const std::array<Binding, 3> bindings{&voxels.scalars, &volume.transferPoints, &voxels.extinction};
  commands.beginPass("classify");
  commands.dispatchLinear(pipeline_, bindings, push, quads);
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

}  // namespace freevoxels
