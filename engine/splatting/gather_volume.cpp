#include "engine/splatting/gather_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "embedded/brick_quads.h"
#include "embedded/shade_blocks.h"
#include "embedded/skip_cells.h"
#include "engine/core/error.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kTexelsIn = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
constexpr VkDescriptorType kTexelsOut = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
constexpr VkBufferUsageFlags kTexels = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

int firstSkipLevel(const HierarchyLayout& hierarchy) {
  return std::min(shader::kSkipLevels, hierarchy.top());
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
  return std::max(brightest * kStoredDepth / kBrightest, 1.0);
}

/// What there is of every occupied block. One more, as no buffer is empty.
std::uint64_t recordCount(std::uint64_t storedBlocks) {
  return storedBlocks + 1;
}

/// Of the device's memory one part in so many may hold quads that the frame does not read.
constexpr std::uint64_t kKeptShare = 4;

bool dependsOnView(const Lighting& lighting) {
  return lighting.phaseG != 0.0 || lighting.surface > 0.0;
}

/// World length of a voxel's layer along its major axis, mean over all directions: about 1.2 voxel edges.
float meanLayer(const DeviceVolume& volume) {
  return float(1.2 * volume.voxelSize);
}

}  // namespace

GatherVolume::GatherVolume(const Device& device, const BuiltVolume& built, std::vector<StageTime>& times)
    : device_(device),
      built_(built),
      skipPass_(makeComputePipeline(
          device, {skip_cells_spv, "skip cells"},
          {.bindings = {kStorage, kStorage}, .pushConstantBytes = sizeof(shader::SkipCellsPush)},
          {shader::kOccupancyThreads, 1, 1})),
      frame_(device, sizeof(shader::SetupFrame), MemoryUse::Device, "shading frame"),
      sources_(device, recordCount(built.volume.storedBlocks()) * sizeof(glm::uvec2), MemoryUse::Device, "source terms",
               kTexels),
      sourceTexels_(device, sources_, VK_FORMAT_R32G32_UINT) {
  makeTowards(1);  // a binding needs a buffer
  makeBricks(times);
}

/// Which cells of the octree are bricks: those that hold anything, or whose next neighbours do.
void GatherVolume::makeBricks(std::vector<StageTime>& times) {
  const DeviceVolume& volume = built_.volume;
  const HierarchyLayout& hierarchy = volume.hierarchy;
  const int firstLevel = firstSkipLevel(hierarchy);
  std::vector<std::uint32_t> occupied(skipCellCount(hierarchy));
  const Buffer cells(device_, occupied.size() * sizeof(std::uint32_t), MemoryUse::Device, "brick cells");
  Commands commands(device_);
  commands.beginPass("gather occupancy");
  const std::array<Binding, 2> bindings{&volume.occupancy, &cells};
  for (int level = firstLevel; level <= hierarchy.top(); ++level) {
    const shader::SkipCellsPush push{.level = volume.onDevice(level),
                                     .firstCell = hierarchy.first[std::size_t(firstLevel)],
                                     .count = std::uint32_t(hierarchy.words(level)) * shader::kBlocksPerWord};
    commands.dispatchLinear(skipPass_, bindings, push, push.count);
  }
  commands.barrier(kCompute, VK_PIPELINE_STAGE_2_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT);
  commands.submitAndWait();
  addTimes(times, commands.times());
  const StageTimer timer(times, "number bricks");
  download(device_, cells, std::as_writable_bytes(std::span(occupied)));

  std::vector<std::uint32_t> numbers;
  constexpr int kOutside = 1 << 29;
  std::vector<glm::ivec4> bricks{glm::ivec4(kOutside)};  // the empty one
  for (int number = 0; number <= hierarchy.top(); ++number) {
    const int cellLevel = std::min(number + shader::kSkipLevels, hierarchy.top());
    const shader::BlockLevel layout = volume.onDevice(cellLevel);
    const glm::ivec3 strides(1, layout.rowPitch, layout.rowPitch * layout.dimensions.y);
    levels_.push_back({.dimensions = volume.onDevice(number).dimensions,
                       .firstCell = int(numbers.size()),
                       .cellStrides = strides,
                       .lastCell = layout.dimensions - 1});
    firstBricks_.push_back(std::uint32_t(bricks.size()));
    const std::uint32_t firstCell = layout.first - hierarchy.first[std::size_t(firstLevel)];
    numbers.resize(numbers.size() + std::size_t(strides.z) * std::size_t(layout.dimensions.z), 0);
    for (int z = 0; z < layout.dimensions.z; ++z)
      for (int y = 0; y < layout.dimensions.y; ++y)
        for (int x = 0; x < layout.dimensions.x; ++x) {
          const auto cell = std::size_t(x + strides.y * y + strides.z * z);
          if (occupied[firstCell + cell] == 0) continue;
          numbers[std::size_t(levels_.back().firstCell) + cell] = std::uint32_t(bricks.size());
          bricks.emplace_back(glm::ivec3(x, y, z) * shader::kGatherGroup, 0);
        }
  }
  firstBricks_.push_back(std::uint32_t(bricks.size()));
  brickNumbers_ = Buffer(device_, numbers.size() * sizeof(std::uint32_t), MemoryUse::Device, "brick numbers", kTexels);
  brickCells_ = Buffer(device_, bricks.size() * sizeof(glm::ivec4), MemoryUse::Device, "brick cells", kTexels);
  upload(device_, brickNumbers_, std::as_bytes(std::span(numbers)));
  upload(device_, brickCells_, std::as_bytes(std::span(bricks)));
  brickNumberTexels_ = TexelView(device_, brickNumbers_, VK_FORMAT_R32_UINT);
  brickCellTexels_ = TexelView(device_, brickCells_, VK_FORMAT_R32G32B32A32_UINT);
}

void GatherVolume::makeTowards(std::uint64_t blocks) {
  const std::uint64_t bytes = blocks * sizeof(std::uint32_t);
  if (towards_.bytes() >= bytes) return;
  towards_ = Buffer(device_, bytes, MemoryUse::Device, "source directions", kTexels);
  towardsTexels_ = TexelView(device_, towards_, VK_FORMAT_R32_UINT);
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

bool GatherVolume::hasColors() const {
  return lit_ || built_.volume.hasColors() || built_.volume.hasEmission();
}

void GatherVolume::prepare(const Shading& shading) {
  const bool lit = shading.lighting != nullptr;
  const bool viewDependent = lit && dependsOnView(*shading.lighting);
  const bool sameLight =
      lit == lit_ && !viewDependent && !viewDependent_ && (!lit || lighting_ == *shading.lighting);
  sourceUnit_ = sourceUnit(built_.volume, shading.lighting);
  lit_ = lit;
  viewDependent_ = viewDependent;
  if (lit)
    lighting_ = *shading.lighting;
  else
    lighting_.reset();
  wantedLevels_ = 0;
  for (int level = shading.frame.detail.finest; level <= shading.frame.detail.coarsest; ++level)
    wantedLevels_ |= 1u << level;
  if (!sameLight) shadedLevels_ = 0;
  for (std::size_t axis = 0; axis < quads_.size(); ++axis)
    if (!sameLight) quads_[axis].levels = 0;
  if (hasTowards()) makeTowards(recordCount(built_.volume.storedBlocks()));
  const auto makeRoomForAll = [&] {
    for (std::size_t axis = 0; axis < quads_.size(); ++axis)
      if (shading.axes[axis]) makeRoom(quads_[axis], shading.axes);
  };
  try {
    makeRoomForAll();
  } catch (const Error& error) {
    if (error.code() != ExitCode::OutOfMemory) throw;
    dropOtherAxes(shading.axes, 0);
    makeRoomForAll();
  }
  // A turntable comes back to the other axes.
  dropOtherAxes(shading.axes, device_.memoryBytes() / kKeptShare);
}

/// Frees quads that hold nothing of use, and those beyond `most` bytes.
void GatherVolume::dropOtherAxes(const std::array<bool, 3>& axes, std::uint64_t most) {
  std::uint64_t kept = 0;
  for (std::size_t axis = 0; axis < quads_.size(); ++axis) {
    Quads& quads = quads_[axis];
    if (axes[axis]) continue;
    kept += quads.extinction.bytes() + quads.source.bytes() + quads.towards.bytes();
    if (quads.levels == 0 || kept > most) quads = {};
  }
}

/// Takes the memory of an axis that holds nothing of use, where there is one.
void GatherVolume::makeRoom(Quads& quads, const std::array<bool, 3>& axes) {
  const std::uint64_t count = std::uint64_t(firstBricks_.back()) * shader::kGatherBrickBlocks;
  if (count > device_.limits().maxTexelBufferElements)
    fail(ExitCode::OutOfMemory, "the gather needs {} quads of voxels, and this device can bind {}: --draw splats has no such limit",
         count, device_.limits().maxTexelBufferElements);
  const auto fits = [&](const Quads& there) {
    const auto holds = [&](const Buffer& buffer, bool needed, std::uint64_t bytes) {
      return buffer.bytes() >= (needed ? count : 1) * bytes;
    };
    return holds(there.extinction, true, sizeof(glm::uvec2)) && holds(there.source, hasColors(), sizeof(glm::uvec4)) &&
           holds(there.towards, hasTowards(), sizeof(glm::uvec4));
  };
  if (fits(quads)) return;
  for (std::size_t other = 0; other < axes.size(); ++other) {
    if (axes[other] || quads_[other].levels != 0 || !fits(quads_[other])) continue;
    quads = std::exchange(quads_[other], {});
    return;
  }
  constexpr VkBufferUsageFlags kUsage = kTexels | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
  quads = {};  // not both at once
  const auto make = [&](Buffer& buffer, TexelView& view, bool needed, std::uint64_t bytes, VkFormat format,
                        const char* name) {
    buffer = Buffer(device_, (needed ? count : 1) * bytes, MemoryUse::Device, name, kUsage);
    view = TexelView(device_, buffer, format);
  };
  make(quads.extinction, quads.extinctionTexels, true, sizeof(glm::uvec2), VK_FORMAT_R32G32_UINT, "extinction quads");
  make(quads.source, quads.sourceTexels, hasColors(), sizeof(glm::uvec4), VK_FORMAT_R32G32B32A32_UINT, "source quads");
  make(quads.towards, quads.towardsTexels, hasTowards(), sizeof(glm::uvec4), VK_FORMAT_R32G32B32A32_UINT,
       "source direction quads");
}

void GatherVolume::record(Commands& commands, const Shading& shading) {
  if ((wantedLevels_ & ~shadedLevels_) != 0) recordShading(commands, shading);
  for (int axis = 0; axis < 3; ++axis)
    if (shading.axes[std::size_t(axis)] && (wantedLevels_ & ~quads_[std::size_t(axis)].levels) != 0)
      recordQuads(commands, axis);
}

void GatherVolume::recordQuads(Commands& commands, int axis) {
  const DeviceVolume& volume = built_.volume;
  Quads& quads = quads_[std::size_t(axis)];
  const Pipeline pass = makeComputePipeline(
      device_, {brick_quads_spv, "brick quads"},
      {.bindings = {kTexelsIn, kTexelsIn, kTexelsIn, kTexelsIn, kTexelsOut, kTexelsOut, kTexelsOut},
       .pushConstantBytes = sizeof(shader::BrickQuadsPush)},
      {shader::kBrickQuadsThreads, 1, 1}, {std::uint32_t(axis), hasTowards(), hasColors()});
  const std::array<Binding, 7> bindings{&brickCellTexels_,       &volume.occupancyTexels,  &sourceTexels_,      &towardsTexels_,
                                        &quads.extinctionTexels, &quads.sourceTexels, &quads.towardsTexels};
  const auto make = [&](int number, std::uint32_t first, std::uint32_t end) {
    if (first == end) return;
    const shader::BrickQuadsPush push{.level = volume.onDevice(number),
                                      .firstBrick = first,
                                      .count = (end - first) * shader::kGatherBrickBlocks};
    commands.dispatchLinear(pass, bindings, push, push.count);
  };
  commands.beginPass("brick quads");
  if (quads.levels == 0) make(0, 0, 1);  // the empty brick
  for (int number = 0; number <= volume.hierarchy.top(); ++number)
    if (((wantedLevels_ & ~quads.levels) >> number & 1u) != 0)
      make(number, firstBricks_[std::size_t(number)], firstBricks_[std::size_t(number) + 1]);
  commands.barrier(kCompute, kCompute);
  quads.levels |= wantedLevels_;
}

void GatherVolume::recordShading(Commands& commands, const Shading& shading) {
  const DeviceVolume& volume = built_.volume;
  shadePass_ = makeComputePipeline(
      device_, {shade_blocks_spv, "shade blocks"},
      {.bindings = std::vector(12, kStorage), .pushConstantBytes = sizeof(shader::ShadePush)},
      {shader::kShadeThreads, 1, 1},
      {lit_, volume.hasEmission(), volume.hasAlbedos, shading.frame.tinted, hasTowards()});
  commands.beginPass("shade blocks");
  commands.update(frame_, shading.frame.setup);
  for (int level = 0; level <= volume.hierarchy.top(); ++level)
    if (((wantedLevels_ & ~shadedLevels_) >> level & 1u) != 0) shade(commands, shading, level);
  shadedLevels_ |= wantedLevels_;
}

void GatherVolume::describe(shader::GatherFrame& frame) const {
  frame.extinctionUnit = float(1.0 / (kStoredDepth * built_.volume.voxelSize));
  frame.sourceUnit = float(sourceUnit_);
  frame.color = built_.volume.albedo;
  for (int number = frame.finest; number <= frame.coarsest; ++number) frame.levels[number] = levels_[std::size_t(number)];
}

}  // namespace freevoxels
