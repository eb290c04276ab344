#include "engine/attenuation/attenuation_table.h"

#include <algorithm>
#include <cstdint>

#include "embedded/attenuation_sweep.h"
#include "embedded/attenuation_sweep_x.h"
#include "engine/core/error.h"
#include "engine/vulkan/commands.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

static_assert(shader::kMaximumDepth == float(kMaxCodedDepth));
static_assert(shader::kOpaqueDepth == float(kOpaqueDepth));
static_assert(shader::kCodeDepth8 == int(AttenuationCode::Depth8));
static_assert(shader::kCodeLinear8 == int(AttenuationCode::Linear8));

/// Push constants of the sweep for `direction`, without the slab. The sweep marches against the direction,
/// from where its lines leave the volume.
shader::SweepPush sweepPush(const SlabSweep& sweep, glm::ivec3 direction) {
  const DeviceVolume& volume = sweep.volume;
  const glm::ivec3 extent = volume.layout.dimensions;
  const int row = volume.layout.rowPitch, plane = row * extent.y;
  shader::SweepPush push{.rowPitch = row,
                         .stepLength = float(stepLength(volume.indexToWorld, direction,
                                                        sweep.table.settings.pathLengthCorrection))};
  const auto march = [&](int count, int stride, int towardsEye) {
    push.marchCount = count;
    push.marchStart = towardsEye > 0 ? (count - 1) * stride : 0;
    push.marchStride = towardsEye > 0 ? -stride : stride;
  };
  if (direction.z != 0) {
    march(extent.z, plane, direction.z);
    push.lineCount = extent.y;
    push.sideStep = -direction.y;
    push.sideStride = row;
    return push;
  }
  if (direction.y != 0) {
    march(extent.y, row, direction.y);
    push.lineCount = sweep.slab.count();
    push.sideStride = plane;
  } else {
    push.lineCount = extent.y * sweep.slab.count();
  }
  push.marchStart += sweep.firstVoxel();
  return push;
}

/// The plane of a direction of {-1,0,1}³.
const Buffer& planeOf(const AttenuationTable& table, glm::ivec3 direction) {
  const DirectionSet set = table.settings.directions;
  return table.planes[std::size_t(directionIndex(set, direction * int(set)))];
}

}  // namespace

AttenuationTable makeTable(const Device& device, const DeviceVolume& volume, const TableSettings& settings) {
  // Codes are read four at a time.
  constexpr std::uint64_t kWord = sizeof(std::uint32_t);
  const std::uint64_t bytes = std::max((volume.planeBytes() + kWord - 1) / kWord * kWord, kWord);
  AttenuationTable table{.settings = settings};
  const DirectionSet set = settings.directions;
  for (int i = 0; i < directionCount(set); ++i) {
    const glm::dvec3 d = directionAt(set, i);
    const std::string name = fmt::format("attenuation {},{},{}", d.x, d.y, d.z);
    table.planes.emplace_back(device, bytes, MemoryUse::Device, name.c_str(),
                              VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    table.planeTexels.emplace_back(device, table.planes.back(), VK_FORMAT_R8_UINT);
  }
  table.planeAddresses = Buffer(device, std::size_t(cellCount(set)) * sizeof(VkDeviceAddress), MemoryUse::Device, "attenuation addresses");
  std::vector<VkDeviceAddress> addresses(std::size_t(cellCount(set)), 0);
  for (int i = 0; i < directionCount(set); ++i)
    addresses[std::size_t(cellNumber(set, directionCell(set, i)))] = table.planes[std::size_t(i)].address();
  upload(device, table.planeAddresses, std::as_bytes(std::span(addresses)));
  table.maxCodePerDirection =
      Buffer(device, table.planes.size() * sizeof(std::uint32_t), MemoryUse::Device, "darkest codes");
  return table;
}

SweepStyle sweepStyle(const Device& device) {
  SweepStyle style = sweepStyleOf(device.isCpu());
  style.mostSlabBytes = device.largestBinding(sizeof(glm::vec4));
  return style;
}

AttenuationSweep::AttenuationSweep(const Device& device, const TableSettings& settings)
    : AttenuationSweep(device, settings, sweepStyle(device)) {}

AttenuationSweep::AttenuationSweep(const Device& device, const TableSettings& settings, const SweepStyle& style)
    : device_(device), settings_(settings), style_(style), expand_(device) {
  const auto code = std::uint32_t(settings.code);
  for (int step = -1; step <= 1; ++step)
    bundles_[std::size_t(step + 1)] =
        makeComputePipeline(device, shaders::attenuation_sweep, {code, std::uint32_t(style.voxelsPerThread), std::uint32_t(step)});
  for (int step : {-1, 1})
    rows_[step > 0 ? 1 : 0] =
        makeComputePipeline(device, shaders::attenuation_sweep_x, {code, std::uint32_t(step), std::uint32_t(style.tiledRows)});
  if (settings.directions == DirectionSet::Directions98)
    halves_.emplace(device, settings.code, style.voxelsPerThread);
}

void AttenuationSweep::makeRoom(const SweepPlan& plan) {
  plan_ = plan;
  if (extinction_.bytes() != plan.slabBytes) {
    extinctionQuads_ = {};
    extinction_ = {};  // free the old buffer before allocating the new one
    extinction_ = Buffer(device_, plan.slabBytes, MemoryUse::Device, "extinction of a slab", VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    extinctionQuads_ = TexelView(device_, extinction_);
  }
  const std::uint64_t keptBytes = std::max<std::uint64_t>(plan.keptBytes, sizeof(float));
  if (keptDepths_.bytes() == keptBytes) return;
  keptDepths_ = {};
  keptDepths_ = Buffer(device_, keptBytes, MemoryUse::Device, "depths between slabs");
}

void AttenuationSweep::record(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table) {
  const std::uint64_t own = extinction_.bytes() + keptDepths_.bytes();
  makeRoom(planSweep(volume.layout, settings_.directions, style_, device_.availableBytes() + own));
  const int planes = volume.layout.dimensions.z;
  SlabSweep sweep{.commands = commands,
                  .volume = volume,
                  .table = table,
                  .slab = {},
                  .extinction = extinctionQuads_,
                  .carriedDepths = keptDepths_};
  for (const Slab& slab : plan_.slabs(planes)) {
    sweep.slab = slab;
    sweep.kept = 0;
    if (slab.upwards || slab.count() < planes) {
      const int low = std::max(slab.lowest(planes) - plan_.halo, 0);
      const int high = std::min(slab.lowest(planes) + slab.count() + plan_.halo, planes);
      commands.beginPass("expand voxels");
      sweep.firstQuad = int(expand_.record(commands, volume, low, high - low, extinction_) / 4);
    }
    commands.beginPass("attenuation sweeps");
    for (int y = -1; y <= 1; ++y) recordBundles(sweep, {y, slab.upwards ? -1 : 1});
    if (slab.upwards) {
      for (int y : {-1, 1}) recordBundles(sweep, {y, 0});
      recordRows(sweep);
    }
    if (halves_) halves_->record(sweep);
    commands.barrier(kComputeStage, kComputeStage);
  }
}

void AttenuationSweep::recordRows(SlabSweep& sweep) const {
  for (int x : {-1, 1}) {
    shader::SweepPush push = sweepPush(sweep, {x, 0, 0});
    push.slab = sweep.marchWithinPlanes(0);
    const std::array<Binding, 4> bindings = sweep.bindings(planeOf(sweep.table, {x, 0, 0}));
    sweep.commands.dispatchLinear(rows_[x > 0 ? 0 : 1], std::span(bindings).first(3), push,  // no depths are carried over
                                  std::uint64_t(push.lineCount));
  }
}

void AttenuationSweep::recordBundles(SlabSweep& sweep, glm::ivec2 yz) const {
  for (int x = -1; x <= 1; ++x) {
    shader::SweepPush push = sweepPush(sweep, {x, yz});
    const std::uint64_t threads =
        std::uint64_t(push.lineCount) * std::uint64_t(push.rowPitch / style_.voxelsPerThread);
    push.slab = yz.y != 0 ? sweep.marchAlongZ(threads * std::uint64_t(linesPerThread(style_.voxelsPerThread, x)))
                          : sweep.marchWithinPlanes(push.marchCount);
    sweep.commands.dispatchLinear(bundles_[std::size_t(1 - x)], sweep.bindings(planeOf(sweep.table, {x, yz})),
                                  push, threads);
  }
}

namespace {

/// For every plane, the values of the stored blocks of a level, read from the bytes that start at `first`.
/// Byte i / `share` belongs to block i; `valueOf(byte, i)` extracts its value.
template <typename ValueOf>
std::vector<std::vector<std::uint8_t>> downloadPlanes(const Device& device, const DeviceVolume& volume,
                                                      const AttenuationTable& table, int level,
                                                      VkDeviceSize first, std::size_t share,
                                                      const ValueOf& valueOf) {
  const std::vector<std::uint32_t> blocks = downloadStored(device, volume, level);
  const std::uint64_t count = volume.hierarchy.levels[std::size_t(level)].voxels();
  std::vector<std::vector<std::uint8_t>> result;
  for (const Buffer& plane : table.planes) {
    std::vector<std::uint8_t> stored((blocks.size() + share - 1) / share);
    download(device, plane, std::as_writable_bytes(std::span(stored)), first);
    std::vector<std::uint8_t> codes(blocks.size());
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = valueOf(stored[i / share], i);
    result.push_back(scatterToDense(codes, blocks, count));
  }
  return result;
}

std::uint8_t wholeByte(std::uint8_t byte, std::size_t) {
  return byte;
}

/// The bound of a block in a packed byte (shaders/attenuation_code.glsl).
std::uint8_t boundInByte(std::uint8_t byte, std::size_t block) {
  return std::uint8_t((byte >> (block % shader::kBoundBlocks * 4) & 15) * 16);
}

}  // namespace

std::vector<std::vector<std::uint8_t>> downloadTable(const Device& device, const DeviceVolume& volume,
                                                     const AttenuationTable& table, int level) {
  return downloadPlanes(device, volume, table, level, volume.firstRank(level), 1, wholeByte);
}

std::vector<std::vector<std::uint8_t>> downloadBounds(const Device& device, const DeviceVolume& volume,
                                                      const AttenuationTable& table, int level) {
  return downloadPlanes(device, volume, table, level, volume.firstBound(level), shader::kBoundBlocks,
                        boundInByte);
}

std::vector<double> downloadLargestDepths(const Device& device, const AttenuationTable& table) {
  std::vector<std::uint32_t> codes(table.planes.size());
  download(device, table.maxCodePerDirection, std::as_writable_bytes(std::span(codes)));
  const AttenuationCode code = table.settings.code;
  std::vector<double> depths;
  for (const std::uint32_t maxCodePerDirection : codes)
    depths.push_back(
        decodeOpticalDepth(code, code == AttenuationCode::Linear8 ? 255 - int(maxCodePerDirection) : int(maxCodePerDirection)));
  return depths;
}

}  // namespace freevoxels
