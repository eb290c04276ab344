#include "engine/visibility/cut_pass.h"

#include <algorithm>
#include <array>
#include <ranges>

#include "embedded/compact_scan.h"
#include "embedded/cut_select.h"
#include "embedded/cut_write.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

constexpr const char* kPassName = "level of detail and culling";

std::uint64_t groupsFor(std::uint64_t slots) {
  return (slots + shader::kCutSlotsPerGroup - 1) / shader::kCutSlotsPerGroup;
}

/// Upper bound of the number of drawn blocks: every drawn block contains at least one occupied block of the
/// finest level, and shares it with no other.
std::uint64_t mostDrawn(const CutInputs& inputs) {
  std::uint64_t most = inputs.volume.stored[std::size_t(inputs.detail.finest)];
  if (inputs.candidates != nullptr) {
    std::uint64_t candidates = 1;  // the coarsest
    for (std::size_t level = std::size_t(inputs.detail.finest); level < inputs.candidates->levels.size(); ++level)
      candidates += inputs.candidates->levels[level].mostBlocks;
    most = std::min(most, candidates);
  }
  return std::max<std::uint64_t>(most, 1);
}

/// For each direction, the least stored optical depth that hides a block whose line of sight has length 1 a
/// layer; without path-length correction, for any line of sight.
void setDarkDepths(shader::CutFrame& frame, const CutInputs& inputs) {
  if (inputs.table == nullptr) return;
  const DirectionSet set = inputs.table->settings.directions;
  const int cells = int(set);
  const glm::dmat3 linear(inputs.volume.indexToWorld);
  for (int i = 0; i < directionCount(set); ++i) {
    const glm::ivec3 cell = directionCell(set, i);
    const double length = frame.pathLengthCorrection ? glm::length(linear * glm::dvec3(cell)) / cells : 1.0;
    frame.darkDepths[cellNumber(set, cell)] = float(inputs.cull.hiddenDepth * length);
  }
  for (int axis = 0; axis < 3; ++axis) frame.axisLengths[axis] = float(glm::length(linear[axis]));
}

shader::CutFrame cutFrame(const CutInputs& inputs) {
  const DeviceVolume& volume = inputs.volume;
  const shader::SetupFrame& setup = inputs.setup;
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.layout.dimensions - 1);
  shader::CutFrame frame{.coarseFirst = std::uint32_t(volume.stored.front()),
                         .top = volume.hierarchy.top(),
                         .finest = inputs.detail.finest,
                         .coarsest = inputs.detail.coarsest,
                         .middle = middle,
                         .viewAxis = inputs.detail.viewAxis,
                         .middleDistance = float(glm::dot(inputs.detail.viewAxis, middle - inputs.detail.eye)),
                         .edgePerDistance = float(inputs.detail.edgePerDistance),
                         .outside = inputs.cull.outside ? 1 : 0,
                         .hides = inputs.cull.hiddenDepth > 0.0 ? 1 : 0,
                         .indexToWorld = setup.indexToWorld,
                         .eyeToMiddle = setup.eyeToMiddle,
                         .ray = setup.ray,
                         .orthographic = setup.orthographic,
                         .pathLengthCorrection = setup.pathLengthCorrection,
                         .cells = setup.cells};
  std::ranges::copy(setup.levels, frame.levels);
  std::ranges::copy(inputs.cull.planes, frame.planes);
  setDarkDepths(frame, inputs);
  return frame;
}

}  // namespace

CutPass::CutPass(const Device& device, AttenuationCode code)
    : device_(device),
      code_(code),
      scan_(makeComputePipeline(device, shaders::compact_scan)),
      write_(makeComputePipeline(device, shaders::cut_write)),
      frame_(device, sizeof(shader::CutFrame), MemoryUse::Device, "cut frame", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      counts_(device, sizeof(shader::CutCounts), MemoryUse::Device, "cut counts") {}

void CutPass::makeRoom(const CutInputs& inputs) {
  const std::uint64_t most = mostBlocks_ = mostDrawn(inputs);
  const std::uint64_t groups = std::max<std::uint64_t>(groupCount_, 1);
  const std::uint64_t words = std::max<std::uint64_t>((inputs.volume.coarseBlocks() + 31) / 32, 1);
  cut_.chunkCount = std::uint32_t((most + shader::kSplatsPerChunk - 1) / shader::kSplatsPerChunk);
  growBuffer(device_, opened_, words * sizeof(std::uint32_t), "opened blocks");
  growBuffer(device_, masks_, groups * shader::kCutThreads * sizeof(std::uint32_t), "cut masks");
  growBuffer(device_, cut_.groupOffsets, (groups + 1) * sizeof(std::uint32_t), "cut group offsets");
  growBuffer(device_, cut_.indices, most * sizeof(std::uint32_t), "cut");
  growBuffer(device_, cut_.chunks, cut_.chunkCount * sizeof(shader::ChunkArguments), "cut chunk arguments",
             VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
}

/// The levels in the order in which they are processed, from the finest that is drawn.
std::vector<CutPass::Level> CutPass::planLevels(const CutInputs& inputs) {
  std::vector<Level> levels;
  std::uint64_t firstGroup = 0;
  finest_ = inputs.detail.finest;
  firstGroups_.clear();
  const int top = inputs.volume.hierarchy.top();
  for (int level = finest_; level <= top; ++level) {
    const CutCandidates::Level* const some =
        inputs.candidates != nullptr && level < top ? &inputs.candidates->levels[std::size_t(level)] : nullptr;
    const std::uint64_t parents = some != nullptr ? some->parentCount : level == top ? 0 : inputs.volume.stored[std::size_t(level) + 1];
    const std::uint64_t slots = level == top ? 1 : 8 * parents;
    levels.push_back(
        {.parents = some != nullptr ? &some->parents : &inputs.lists.of(std::min(level + 1, top), inputs.voxels).indices,
         .children = some != nullptr ? &some->children : nullptr,
         .push = {
             .level = level, .slotCount = std::uint32_t(slots), .firstGroup = std::uint32_t(firstGroup)}});
    if (level > inputs.detail.coarsest) continue;
    firstGroups_.push_back(std::uint32_t(firstGroup));
    firstGroup += groupsFor(slots);
  }
  groupCount_ = std::uint32_t(firstGroup);
  return levels;
}

void CutPass::record(Commands& commands, const CutInputs& inputs) {
  commands.beginPass(kPassName);
  const std::vector<Level> levels = planLevels(inputs);
  makeRoom(inputs);
  for (const Buffer* buffer : {&opened_, &counts_, &cut_.chunks}) commands.clear(*buffer);
  commands.update(frame_, cutFrame(inputs));
  recordSelect(commands, inputs, levels);
  recordList(commands, std::span(levels).first(firstGroups_.size()));
}

void CutPass::recordSelect(Commands& commands, const CutInputs& inputs, std::span<const Level> levels) {
  const Buffer& anyBuffer = frame_;
  for (const Level& level : levels | std::views::reverse) {
    const std::array<Binding, 9> bindings{&frame_,
                                          level.parents,
                                          &inputs.volume.occupancy,
                                          &opened_,
                                          &masks_,
                                          &cut_.groupOffsets,
                                          &counts_,
                                          inputs.table ? &inputs.table->planeAddresses : &anyBuffer,
                                          level.children != nullptr ? level.children : &anyBuffer};
    const Pipeline select =
        makeComputePipeline(device_, shaders::cut_select, {std::uint32_t(code_), level.push.level == 0, level.children != nullptr});
    if (level.push.slotCount > 0)
      commands.dispatchLinear(select, bindings, level.push, groupsFor(level.push.slotCount) * shader::kCutThreads);
    commands.barrier(kComputeStage, kComputeStage);
  }
}

void CutPass::recordList(Commands& commands, std::span<const Level> levels) {
  const std::array<Binding, 2> scan{&cut_.groupOffsets, &cut_.chunks};
  commands.dispatchLinear(scan_, scan, shader::CompactPush{.groupCount = groupCount_, .chunkCount = cut_.chunkCount}, shader::kScanThreads);
  commands.barrier(kComputeStage, kComputeStage | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
  for (const Level& level : levels) {
    const std::array<Binding, 5> bindings{&frame_, level.parents, &masks_, &cut_.groupOffsets, &cut_.indices};
    if (level.push.slotCount > 0)
      commands.dispatchLinear(write_, bindings, level.push, groupsFor(level.push.slotCount) * shader::kCutThreads);
  }
  commands.barrier(kComputeStage, kComputeStage);
}

/// Counts the drawn blocks of each level by the offsets of the levels' first workgroups.
std::vector<std::uint64_t> CutPass::drawnByLevel() const {
  std::vector<std::uint32_t> offsets(cut_.groupOffsets.bytes() / sizeof(std::uint32_t));
  download(device_, cut_.groupOffsets, std::as_writable_bytes(std::span(offsets)));
  std::vector<std::uint64_t> drawn(std::size_t(finest_), 0);
  for (std::size_t level = 0; level < firstGroups_.size(); ++level) {
    const std::uint32_t begin = firstGroups_[level];
    const std::uint32_t end = level + 1 < firstGroups_.size() ? firstGroups_[level + 1] : groupCount_;
    drawn.push_back(offsets[end] - offsets[begin]);
  }
  return drawn;
}

CutCounts CutPass::counts() const {
  shader::CutCounts found;
  download(device_, counts_, std::as_writable_bytes(std::span(&found, 1)));
  CutCounts result{.empty = found.empty,
                   .outside = found.outside,
                   .hidden = found.hidden,
                   .opened = found.opened,
                   .drawn = drawnByLevel()};
  result.considered = result.empty + result.outside + result.hidden + result.opened;
  for (const std::uint64_t count : result.drawn) result.considered += count;
  return result;
}

}  // namespace freevoxels
