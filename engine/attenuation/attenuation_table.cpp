#include "engine/attenuation/attenuation_table.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "embedded/attenuation_sweep.h"
#include "embedded/attenuation_sweep_x.h"
#include "engine/core/error.h"
#include "engine/hierarchy/volume_memory.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

static_assert(shader::kMaximumDepth == float(kMaximumCodedDepth));
static_assert(shader::kOpaqueDepth == float(kOpaqueDepth));
static_assert(shader::kCodeDepth8 == int(AttenuationCode::Depth8));
static_assert(shader::kCodeLinear8 == int(AttenuationCode::Linear8));

/// A CPU device sweeps the three directions that share their y and z in blocks of lines of this much
/// extinction, so that two of the three find it in the cache.
constexpr std::uint64_t kCpuBlockBytes = std::uint64_t(4) << 20;

/// The sweep for `direction` marches the other way: from where its lines leave the volume, against the
/// direction.
shader::SweepPush sweepPush(const DeviceVolume& volume, glm::ivec3 direction, bool pathLengthCorrection) {
  const glm::ivec3 extent = volume.layout.dimensions;
  const int row = volume.layout.rowPitch, plane = row * extent.y;
  shader::SweepPush push{
      .rowPitch = row,
      .stepLength = float(freevoxels::stepLength(volume.indexToWorld, direction, pathLengthCorrection))};
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
  } else if (direction.y != 0) {
    march(extent.y, row, direction.y);
    push.lineCount = extent.z;
    push.sideStride = plane;
  } else {
    push.lineCount = extent.y * extent.z;
  }
  push.lastLine = push.lineCount;
  return push;
}

/// Of the direction {-1,0,1}³.
const Buffer& planeOf(const AttenuationTable& table, glm::ivec3 direction) {
  const DirectionSet set = table.settings.directions;
  return table.planes[std::size_t(directionIndex(set, direction * int(set)))];
}

Pipeline makeSweepPipeline(const Device& device, ShaderCode code, const Specialisation& constants) {
  return makeComputePipeline(
      device, code,
      {.bindings = {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER},
       .pushConstantBytes = sizeof(shader::SweepPush)},
      {shader::kSweepThreads, 1, 1}, constants);
}

}  // namespace

AttenuationTable makeTable(const Device& device, const DeviceVolume& volume, const TableSettings& settings) {
  checkTableFits(device, volume, settings.directions);
  // Look-ups read whole words.
  const std::uint64_t bytes = std::max<std::uint64_t>((volume.planeBytes() + 3) / 4 * 4, 4);
  AttenuationTable table{.settings = settings};
  const DirectionSet set = settings.directions;
  const int edge = 2 * int(set) + 1;
  std::vector<VkDeviceAddress> addresses(std::size_t(edge * edge * edge), 0);
  for (int i = 0; i < directionCount(set); ++i) {
    const glm::dvec3 d = directionAt(set, i);
    const std::string name = fmt::format("attenuation {},{},{}", d.x, d.y, d.z);
    table.planes.emplace_back(device, bytes, MemoryUse::Device, name.c_str(),
                              VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    table.planeTexels.emplace_back(device, table.planes.back(), VK_FORMAT_R8_UINT);
    addresses[std::size_t(cellNumber(set, directionCell(set, i)))] = table.planes.back().address();
  }
  const std::span<const std::byte> list = std::as_bytes(std::span(addresses));
  table.planeAddresses = Buffer(device, list.size(), MemoryUse::Device, "attenuation addresses");
  upload(device, table.planeAddresses, list);
  table.darkest =
      Buffer(device, table.planes.size() * sizeof(std::uint32_t), MemoryUse::Device, "darkest codes");
  return table;
}

AttenuationSweep::AttenuationSweep(const Device& device, const TableSettings& settings)
    : device_(device),
      voxelsPerThread_(device.isCpu() ? 16 : 4),
      blockBytes_(device.isCpu() ? kCpuBlockBytes : std::numeric_limits<std::uint64_t>::max()),
      expand_(device) {
  const auto code = std::uint32_t(settings.code);
  for (int step = -1; step <= 1; ++step)
    bundles_[std::size_t(step + 1)] =
        makeSweepPipeline(device, {attenuation_sweep_spv, "attenuation sweep"},
                          {code, std::uint32_t(voxelsPerThread_), std::uint32_t(step)});
  for (int step : {-1, 1})
    rows_[step > 0 ? 1 : 0] = makeSweepPipeline(device, {attenuation_sweep_x_spv, "attenuation sweep x"},
                                                {code, std::uint32_t(step)});
  if (settings.directions == DirectionSet::Directions98)
    halves_.emplace(device, settings.code, voxelsPerThread_);
}

void AttenuationSweep::record(Commands& commands, const DeviceVolume& volume, const AttenuationTable& table) {
  const std::uint64_t bytes = volume.hierarchy.denseVoxels() * sizeof(float);
  if (extinction_.bytes() != bytes) {
    extinctionQuads_ = {};
    extinction_ = {};  // not both at once
    extinction_ = Buffer(device_, bytes, MemoryUse::Device, "extinction of all voxels",
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    extinctionQuads_ = TexelView(device_, extinction_);
  }
  commands.beginPass("expand voxels");
  expand_.record(commands, volume, extinction_);
  commands.beginPass("attenuation sweeps");
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      if (y == 0 && z == 0)
        recordRows(commands, volume, table);
      else
        recordBundles(commands, volume, table, {y, z});
  if (halves_) halves_->record(commands, volume, extinctionQuads_, table);
  commands.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
}

void AttenuationSweep::recordRows(Commands& commands, const DeviceVolume& volume,
                                  const AttenuationTable& table) const {
  for (int x : {-1, 1}) {
    const shader::SweepPush push = sweepPush(volume, {x, 0, 0}, table.settings.pathLengthCorrection);
    const std::array<Binding, 3> bindings{&extinctionQuads_, &planeOf(table, {x, 0, 0}),
                                          &volume.occupancyTexels};
    commands.dispatchLinear(rows_[x > 0 ? 0 : 1], bindings, push, std::uint64_t(push.lineCount));
  }
}

void AttenuationSweep::recordBundles(Commands& commands, const DeviceVolume& volume,
                                     const AttenuationTable& table, glm::ivec2 yz) const {
  const shader::SweepPush any = sweepPush(volume, {0, yz}, table.settings.pathLengthCorrection);
  const int bundles = any.rowPitch / voxelsPerThread_;
  const std::uint64_t lineBytes = std::uint64_t(any.rowPitch) * std::uint64_t(any.marchCount) * sizeof(float);
  const int block = int(std::clamp<std::uint64_t>(blockBytes_ / lineBytes, 1, std::uint64_t(any.lineCount)));
  for (int first = 0; first < any.lineCount; first += block)
    for (int x = -1; x <= 1; ++x) {
      shader::SweepPush push = sweepPush(volume, {x, yz}, table.settings.pathLengthCorrection);
      push.firstLine = first;
      push.lastLine = std::min(first + block, push.lineCount);
      const std::array<Binding, 3> bindings{&extinctionQuads_, &planeOf(table, {x, yz}),
                                            &volume.occupancyTexels};
      commands.dispatchLinear(bundles_[std::size_t(1 - x)], bindings, push,
                              std::uint64_t(push.lastLine - first) * std::uint64_t(bundles));
    }
}

namespace {

/// Of every plane, the codes from a byte on of what is stored of a level.
std::vector<std::vector<std::uint8_t>> downloadPlanes(const Device& device, const DeviceVolume& volume,
                                                      const AttenuationTable& table, int level,
                                                      VkDeviceSize first) {
  const std::vector<std::uint32_t> blocks = downloadStored(device, volume, level);
  const std::uint64_t count = volume.hierarchy.levels[std::size_t(level)].voxels();
  std::vector<std::uint8_t> stored(blocks.size());
  std::vector<std::vector<std::uint8_t>> result;
  for (const Buffer& plane : table.planes) {
    download(device, plane, std::as_writable_bytes(std::span(stored)), first);
    result.push_back(spreadOut(stored, blocks, count));
  }
  return result;
}

}  // namespace

std::vector<std::vector<std::uint8_t>> downloadTable(const Device& device, const DeviceVolume& volume,
                                                     const AttenuationTable& table, int level) {
  return downloadPlanes(device, volume, table, level, volume.firstRank(level));
}

std::vector<std::vector<std::uint8_t>> downloadBounds(const Device& device, const DeviceVolume& volume,
                                                      const AttenuationTable& table, int level) {
  return downloadPlanes(device, volume, table, level, volume.firstRank(level) + volume.boundsOffset());
}

std::vector<double> downloadLargestDepths(const Device& device, const AttenuationTable& table) {
  std::vector<std::uint32_t> codes(table.planes.size());
  download(device, table.darkest, std::as_writable_bytes(std::span(codes)));
  const AttenuationCode code = table.settings.code;
  std::vector<double> depths;
  for (const std::uint32_t darkest : codes)
    depths.push_back(
        decodeOpticalDepth(code, code == AttenuationCode::Linear8 ? 255 - int(darkest) : int(darkest)));
  return depths;
}

}  // namespace freevoxels
