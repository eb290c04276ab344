#include "engine/splatting/gather_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "embedded/occupancy_windows.h"
#include "embedded/shade_blocks.h"
#include "embedded/skip_cells.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkBufferUsageFlags kTexels = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

int firstSkipLevel(const HierarchyLayout& hierarchy) {
  return std::min(shader::kSkipLevels, hierarchy.top());
}

std::uint64_t windowCount(const HierarchyLayout& hierarchy) {
  return hierarchy.paddedBlocks() / shader::kWindowStep;
}

std::uint64_t skipCellCount(const HierarchyLayout& hierarchy) {
  return hierarchy.paddedBlocks() - hierarchy.first[std::size_t(firstSkipLevel(hierarchy))];
}

/// Stored extinction of an optical depth of 1 a voxel: halves then hold 1e-9 to 1000 of it.
constexpr double kStoredDepth = 64.0;

/// Radiance that a stored source term equal to the stored extinction means: 1, or more where halves would not hold the
/// brightest voxel. Lights are as bright as they are at the least distance that counts.
double sourceUnit(const DeviceVolume& volume, const Lighting* lighting) {
  double brightest = volume.emissionUnit * kBrightest * volume.voxelSize;
  if (lighting != nullptr) {
    for (const Light& light : lighting->lights) {
      const double nearest = light.atInfinity ? 1.0 : double(shader::kNearestLight2) * volume.voxelSize * volume.voxelSize;
      const double color = std::max({light.color.r, light.color.g, light.color.b});
      brightest += light.intensity * color / (4.0 * std::numbers::pi * nearest);
    }
  }
  constexpr double kLargest = 65504.0;
  return std::max(brightest * kStoredDepth / kLargest, 1.0);
}

/// What there is of every occupied block. Two more: the second of two neighbours is read whether or not it is occupied.
std::uint64_t recordCount(std::uint64_t storedBlocks) {
  return storedBlocks + 2;
}

bool dependsOnView(const Lighting& lighting) {
  return lighting.phaseG != 0.0 || lighting.surface > 0.0;
}

/// World length of a voxel's layer along its major axis, mean over all directions: about 1.2 voxel edges.
float meanLayer(const DeviceVolume& volume) {
  return float(1.2 * volume.voxelSize);
}

}  // namespace

GatherVolume::GatherVolume(const Device& device, const BuiltVolume& built)
    : device_(device),
      built_(built),
      firstSkipLevel_(firstSkipLevel(built.volume.hierarchy)),
      windowsPass_(makeComputePipeline(
          device, {occupancy_windows_spv, "occupancy windows"},
          {.bindings = {kStorage, kStorage}, .pushConstantBytes = sizeof(shader::WindowsPush)},
          {shader::kOccupancyThreads, 1, 1})),
      skipPass_(makeComputePipeline(
          device, {skip_cells_spv, "skip cells"},
          {.bindings = {kStorage, kStorage}, .pushConstantBytes = sizeof(shader::SkipCellsPush)},
          {shader::kOccupancyThreads, 1, 1})),
      frame_(device, sizeof(shader::SetupFrame), MemoryUse::Device, "shading frame"),
      windows_(device, windowCount(built.volume.hierarchy) * sizeof(shader::OccupancyWord), MemoryUse::Device,
               "occupancy windows", kTexels),
      skipCells_(device, skipCellCount(built.volume.hierarchy) * sizeof(std::uint32_t), MemoryUse::Device, "skip cells",
                 kTexels),
      sources_(device, recordCount(built.volume.storedBlocks()) * sizeof(glm::uvec2), MemoryUse::Device, "source terms",
               kTexels),
      windowTexels_(device, windows_, VK_FORMAT_R32G32_UINT),
      skipTexels_(device, skipCells_, VK_FORMAT_R32_UINT),
      sourceTexels_(device, sources_, VK_FORMAT_R32G32_UINT) {
  makeTowards(1);  // a binding needs a buffer
}

void GatherVolume::makeTowards(std::uint64_t blocks) {
  const std::uint64_t bytes = blocks * sizeof(std::uint32_t);
  if (towards_.bytes() >= bytes) return;
  towards_ = Buffer(device_, bytes, MemoryUse::Device, "source directions", kTexels);
  towardsTexels_ = TexelView(device_, towards_, VK_FORMAT_R8G8B8A8_SNORM);
}

void GatherVolume::recordOccupancy(Commands& commands) {
  const DeviceVolume& volume = built_.volume;
  const auto windows = std::uint32_t(windowCount(volume.hierarchy));
  commands.beginPass("gather occupancy");
  // Blocks of weight 0 are read whether or not they were shaded, and must be finite.
  commands.clear(sources_);
  const std::array<Binding, 2> windowBindings{&volume.occupancy, &windows_};
  commands.dispatchLinear(windowsPass_, windowBindings, shader::WindowsPush{windows}, windows);
  const std::array<Binding, 2> skipBindings{&volume.occupancy, &skipCells_};
  for (int level = firstSkipLevel_; level <= volume.hierarchy.top(); ++level) {
    const shader::SkipCellsPush push{
        .level = volume.onDevice(level),
        .firstCell = volume.hierarchy.first[std::size_t(firstSkipLevel_)],
        .count = std::uint32_t(volume.hierarchy.words(level)) * shader::kBlocksPerWord};
    commands.dispatchLinear(skipPass_, skipBindings, push, push.count);
  }
  commands.barrier(kCompute, kCompute);
  hasOccupancy_ = true;
}

void GatherVolume::shade(Commands& commands, const Shading& shading, int level) {
  const DeviceVolume& volume = built_.volume;
  const auto count = std::uint32_t(volume.stored[std::size_t(level)]);
  if (count == 0) return;
  const Buffer& anyBuffer = frame_;
  const bool colors = volume.hasColors();
  const std::array<Binding, 12> bindings{&frame_,
                                         &volume.transferPoints,
                                         shading.table != nullptr ? &shading.table->planeAddresses : &anyBuffer,
                                         &built_.lists.of(level, built_.visible).indices,
                                         colors ? &volume.scalars : &anyBuffer,
                                         &volume.extinction,
                                         &sources_,
                                         colors ? &volume.blockColors : &anyBuffer,
                                         &volume.occupancy,
                                         shading.lights != nullptr ? shading.lights : &anyBuffer,
                                         volume.hasEmission() ? &volume.emission : &anyBuffer,
                                         &towards_};
  const shader::ShadePush push{
      .firstRank = volume.firstRank(level),
      .count = count,
      .extinctionScale = float(kStoredDepth * volume.voxelSize),
      .sourceScale = float(kStoredDepth * volume.voxelSize / sourceUnit_),
      .meanLayer = meanLayer(volume)};
  commands.dispatchLinear(shadePass_, bindings, push, count);
  commands.barrier(kCompute, kCompute);
}

void GatherVolume::record(Commands& commands, const Shading& shading) {
  if (!hasOccupancy_) recordOccupancy(commands);
  const bool lit = shading.lighting != nullptr;
  const bool viewDependent = lit && dependsOnView(*shading.lighting);
  const bool sameLight =
      lit == lit_ && !viewDependent && !viewDependent_ && (!lit || lighting_ == *shading.lighting);
  if (!sameLight) shadedLevels_ = 0;
  sourceUnit_ = sourceUnit(built_.volume, shading.lighting);
  lit_ = lit;
  viewDependent_ = viewDependent;
  if (lit)
    lighting_ = *shading.lighting;
  else
    lighting_.reset();
  std::uint32_t wanted = 0;
  for (int level = shading.frame.detail.finest; level <= shading.frame.detail.coarsest; ++level)
    wanted |= 1u << level;
  if ((wanted & ~shadedLevels_) == 0) return;

  const DeviceVolume& volume = built_.volume;
  shadePass_ = makeComputePipeline(
      device_, {shade_blocks_spv, "shade blocks"},
      {.bindings = std::vector(12, kStorage), .pushConstantBytes = sizeof(shader::ShadePush)},
      {shader::kShadeThreads, 1, 1},
      {lit, volume.hasEmission(), volume.hasAlbedos, shading.frame.tinted, hasTowards()});
  if (hasTowards()) makeTowards(recordCount(volume.storedBlocks()));
  commands.beginPass("shade blocks");
  commands.update(frame_, shading.frame.setup);
  for (int level = 0; level <= volume.hierarchy.top(); ++level)
    if (((wanted & ~shadedLevels_) >> level & 1u) != 0) shade(commands, shading, level);
  shadedLevels_ |= wanted;
}

shader::GatherLevel GatherVolume::level(int number) const {
  const HierarchyLayout& hierarchy = built_.volume.hierarchy;
  const int skip = std::min(number + shader::kSkipLevels, hierarchy.top());
  shader::GatherLevel level{.level = built_.volume.onDevice(number),
                            .firstWindow = hierarchy.first[std::size_t(number)] / shader::kWindowStep,
                            .skip = built_.volume.onDevice(skip),
                            .skipShift = skip - number};
  level.skip.first -= hierarchy.first[std::size_t(firstSkipLevel_)];
  return level;
}

void GatherVolume::describe(shader::GatherFrame& frame) const {
  frame.extinctionUnit = float(1.0 / (kStoredDepth * built_.volume.voxelSize));
  frame.sourceUnit = float(sourceUnit_);
  for (int number = frame.finest; number <= frame.coarsest; ++number) frame.levels[number] = level(number);
}

}  // namespace freevoxels
