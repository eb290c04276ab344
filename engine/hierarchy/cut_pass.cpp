#include "engine/hierarchy/cut_pass.h"

#include <algorithm>
#include <array>

#include "embedded/cut_select.h"
#include "embedded/cut_write.h"
#include "embedded/visible_scan.h"

namespace freevoxels {

namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

std::uint64_t groupsFor(std::uint64_t blocks) {
  return (blocks + shader::kCutBlocksPerGroup - 1) / shader::kCutBlocksPerGroup;
}

Pipeline makePass(const Device& device, ShaderCode code, std::size_t bindings, std::uint32_t pushBytes,
                  int threads) {
  return makeComputePipeline(
      device, code,
      {.bindings = std::vector(bindings, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER), .pushConstantBytes = pushBytes},
      {threads, 1, 1});
}

void makeLarger(const Device& device, Buffer& buffer, std::uint64_t bytes, const char* name,
                VkBufferUsageFlags usage = 0) {
  if (buffer.bytes() >= bytes) return;
  buffer = {};  // not both at once
  buffer = Buffer(device, bytes, MemoryUse::Device, name, usage);
}

}  // namespace

CutPass::CutPass(const Device& device)
    : device_(device),
      select_(
          makePass(device, {cut_select_spv, "cut select"}, 3, sizeof(shader::CutPush), shader::kCutThreads)),
      scan_(makePass(device, {visible_scan_spv, "cut scan"}, 2, sizeof(shader::VisiblePush),
                     shader::kScanThreads)),
      write_(
          makePass(device, {cut_write_spv, "cut write"}, 4, sizeof(shader::CutPush), shader::kCutThreads)) {}

std::vector<CutPass::Level> CutPass::levelsOf(const DeviceVolume& volume, const VisibleVoxels& voxels,
                                              const LevelLists& lists, const DetailRule& rule) const {
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.layout.dimensions - 1);
  std::vector<Level> levels;
  std::uint64_t firstGroup = 0;
  for (int level = rule.finest; level <= rule.coarsest; ++level) {
    const std::uint64_t count = lists.counts[std::size_t(level)];
    levels.push_back({&lists.of(level, voxels).indices,
                      {.level = volume.hierarchy.onDevice(level),
                       .edge = Block{.level = level}.edge(),
                       .blockCount = std::uint32_t(count),
                       .firstGroup = std::uint32_t(firstGroup),
                       .finest = rule.finest,
                       .coarsest = rule.coarsest,
                       .viewAxis = rule.viewAxis,
                       .middle = middle,
                       .middleDistance = float(glm::dot(rule.viewAxis, middle - rule.eye)),
                       .edgePerDistance = float(rule.edgePerDistance)}});
    firstGroup += groupsFor(count);
  }
  return levels;
}

void CutPass::makeRoom(std::uint64_t groups, std::uint64_t mostDrawn) {
  cut_.chunkCount = std::uint32_t((mostDrawn + shader::kSplatsPerChunk - 1) / shader::kSplatsPerChunk);
  makeLarger(device_, masks_, groups * shader::kCutThreads * sizeof(std::uint32_t), "cut masks");
  makeLarger(device_, cut_.groupOffsets, groups * sizeof(std::uint32_t), "cut group offsets");
  makeLarger(device_, cut_.indices, mostDrawn * sizeof(std::uint32_t), "cut");
  makeLarger(device_, cut_.chunks, cut_.chunkCount * sizeof(shader::ChunkArguments), "cut chunk arguments",
             VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
}

const VisibleVoxels& CutPass::record(Commands& commands, const DeviceVolume& volume,
                                     const VisibleVoxels& voxels, const LevelLists& lists,
                                     const DetailRule& rule) {
  const std::vector<Level> levels = levelsOf(volume, voxels, lists, rule);
  const std::uint64_t groups = levels.back().push.firstGroup + groupsFor(levels.back().push.blockCount);
  groupCount_ = std::uint32_t(groups);
  // Every block that is drawn holds one of the finest level at least, and shares it with no other.
  makeRoom(std::max<std::uint64_t>(groups, 1), std::max<std::uint64_t>(levels.front().push.blockCount, 1));

  finest_ = rule.finest;
  firstGroups_.clear();
  for (const Level& level : levels) firstGroups_.push_back(level.push.firstGroup);

  commands.beginPass("level of detail");
  for (const Level& level : levels) {
    const std::array<Binding, 3> bindings{level.blocks, &masks_, &cut_.groupOffsets};
    if (level.push.blockCount > 0)
      commands.dispatchLinear(select_, bindings, level.push,
                              groupsFor(level.push.blockCount) * shader::kCutThreads);
  }
  commands.barrier(kCompute, kCompute);
  const std::array<Binding, 2> scan{&cut_.groupOffsets, &cut_.chunks};
  commands.dispatchLinear(
      scan_, scan, shader::VisiblePush{.groupCount = std::uint32_t(groups), .chunkCount = cut_.chunkCount},
      shader::kScanThreads);
  commands.barrier(kCompute, kCompute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
  for (const Level& level : levels) {
    const std::array<Binding, 4> bindings{level.blocks, &masks_, &cut_.groupOffsets, &cut_.indices};
    if (level.push.blockCount > 0)
      commands.dispatchLinear(write_, bindings, level.push,
                              groupsFor(level.push.blockCount) * shader::kCutThreads);
  }
  commands.barrier(kCompute, kCompute);
  return cut_;
}

std::vector<std::uint64_t> CutPass::countDrawn() const {
  std::vector<std::uint32_t> offsets(cut_.groupOffsets.bytes() / sizeof(std::uint32_t));
  download(device_, cut_.groupOffsets, std::as_writable_bytes(std::span(offsets)));
  const std::uint64_t total = downloadVisibleCount(device_, cut_);
  const auto drawnBefore = [&](std::size_t level) {
    return level < firstGroups_.size() && firstGroups_[level] < groupCount_ ? offsets[firstGroups_[level]]
                                                                            : total;
  };
  std::vector<std::uint64_t> counts(std::size_t(finest_), 0);
  for (std::size_t level = 0; level < firstGroups_.size(); ++level)
    counts.push_back(drawnBefore(level + 1) - drawnBefore(level));
  return counts;
}

}  // namespace freevoxels
