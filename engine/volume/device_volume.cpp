#include "engine/volume/device_volume.h"

#include <algorithm>
#include <array>
#include <cstdint>

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
}

void uploadScalars(const Device& device, const Volume& volume, const DeviceVolume& target) {
  const std::size_t count = target.layout.paddedVoxels();
  if (target.scalars.mapped() != nullptr) {
    copyPadded(volume, target.layout, {reinterpret_cast<float*>(target.scalars.mapped()), count});
    return;
  }
  std::vector<float> padded(count);
  copyPadded(volume, target.layout, padded);
  upload(device, target.scalars, std::as_bytes(std::span(padded)));
}

}  // namespace

DeviceVolume uploadVolume(const Device& device, const Volume& volume, const Classification& classification) {
  DeviceVolume result{.layout = GridLayout(volume.dimensions),
                      .hierarchy = HierarchyLayout(volume.dimensions),
                      .indexToWorld = volume.indexToWorld,
                      .albedo = classification.albedo,
                      .voxelSize = volume.voxelSize(),
                      .activeVoxels = volume.activeVoxels};
  result.scalars = Buffer(device, result.layout.paddedVoxels() * sizeof(float), MemoryUse::Device, "scalars");
  result.extinction = Buffer(device, result.hierarchy.paddedBlocks() * sizeof(float), MemoryUse::Device,
                             "extinction", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  result.extinctionQuads = QuadView(device, result.extinction);
  uploadScalars(device, volume, result);

  std::vector<glm::vec4> points;
  if (classification.transferFunction) {
    const TransferFunction& function = *classification.transferFunction;
    for (const auto& point : function.opacity) points.emplace_back(point.scalar, point.opacity, 0.0f, 0.0f);
    for (const auto& point : function.color) points.emplace_back(point.scalar, point.color);
    result.opacityPointCount = std::uint32_t(function.opacity.size());
    result.colorPointCount = std::uint32_t(function.color.size());
    if (result.hierarchy.top() > 0)
      result.blockColors = Buffer(device, result.hierarchy.paddedCoarseBlocks() * sizeof(glm::uvec2),
                                  MemoryUse::Device, "block colours");
  } else {
    points.emplace_back(0.0f);  // a binding needs a buffer
  }
  result.transferPoints =
      Buffer(device, points.size() * sizeof(glm::vec4), MemoryUse::Device, "transfer function");
  upload(device, result.transferPoints, std::as_bytes(std::span(points)));
  return result;
}

ClassifyPass::ClassifyPass(const Device& device)
    : pipeline_(makeComputePipeline(device, {classify_spv, "classify"},
                                    {.bindings = std::vector(3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER),
                                     .pushConstantBytes = sizeof(shader::ClassifyPush)},
                                    {shader::kClassifyThreads, 1, 1})) {}

void ClassifyPass::record(Commands& commands, const DeviceVolume& volume,
                          const Classification& classification) const {
  const std::uint64_t quads = volume.layout.paddedVoxels() / 4;
  const shader::ClassifyPush push{
      .quadCount = std::uint32_t(quads),
      .opacityPoints = volume.opacityPointCount,
      .densityScale = float(std::min(classification.densityScale, kMaximumExtinction)),
      .unitDistance =
          classification.transferFunction ? float(classification.transferFunction->unitDistance) : 1.0f};
  const std::array<Binding, 3> bindings{&volume.scalars, &volume.transferPoints, &volume.extinction};
  commands.beginPass("classify");
  commands.dispatchLinear(pipeline_, bindings, push, quads);
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

}  // namespace freevoxels
