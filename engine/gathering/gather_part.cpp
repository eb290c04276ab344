#include "engine/gathering/gather_part.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "engine/core/error.h"
#include "engine/octree/hilbert.h"
#include "engine/volume/coarse_cells.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

/// A ray adds at most 2^kMaxBricksLog2 bricks' optical depths, of at most kMaxBrickDepth = 2^4 each, within 63 bits.
constexpr int kMaxBricksLog2 = 12, kDepthDigits = 62 - 4 - kMaxBricksLog2;
constexpr int kMaxChunkLevels = 2;  ///< a chunk has at most 2^this bricks along an edge
constexpr std::uint64_t kChunksPerShare = 4;

template <typename Visit>
void forEachCell(glm::ivec3 size, const Visit& visit) {
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < size.z; ++cell.z)
    for (cell.y = 0; cell.y < size.y; ++cell.y)
      for (cell.x = 0; cell.x < size.x; ++cell.x) visit(cell);
}

/// For each brick the number of its chunk in Hilbert order. A chunk has 4^3 bricks, or 2^3 or one where a level has fewer than
/// kChunksPerShare chunks a share. Large chunks cost less, as rays through a part also pass slices of its neighbours.
std::vector<std::pair<std::uint64_t, glm::ivec3>> chunkPositions(const std::vector<glm::ivec3>& bricks, glm::ivec3 size) {
  std::vector<std::pair<std::uint64_t, glm::ivec3>> positions;
  for (int levels = kMaxChunkLevels; levels >= 0; --levels) {
    positions.clear();
    for (const glm::ivec3 brick : bricks) positions.emplace_back(hilbertIndex(glm::uvec3(brick >> levels), hilbertBits(size)), brick);
    std::ranges::stable_sort(positions, {}, &std::pair<std::uint64_t, glm::ivec3>::first);
    std::uint64_t chunks = 0, last = ~std::uint64_t(0);
    for (auto& [index, brick] : positions) {
      if (index != last) ++chunks;
      last = std::exchange(index, chunks - 1);
    }
    if (chunks >= kChunksPerShare * kShares) break;
  }
  return positions;
}

SampleLattice latticeOf(const shader::GatherFrame& frame, bool scalars, bool depth) {
  SampleLattice lattice{.samples = frame.samples,
                        .pitch = double(frame.pitch),
                        .first = frame.firstSample,
                        .mainAxis = frame.mainAxis,
                        .orthographic = frame.orthographic != 0,
                        .scalars = scalars,
                        .depth = depth,
                        .seenLow = frame.seenLow,
                        .seenHigh = frame.seenHigh};
  for (std::size_t axis = 0; axis < 3; ++axis)
    lattice.axes[axis] = {frame.axes[axis].along, frame.axes[axis].tilt, double(frame.axes[axis].tiltDepth)};
  return lattice;
}

}  // namespace

FixedSums partSums(const shader::GatherFrame& frame, bool scalars, FixedSums layout) {
  layout.lattice = latticeOf(frame, scalars, layout.channels == kSumChannels);
  layout.channels = kSumChannels;
  layout.method = "gather, " + layout.method;
  layout.digits[std::size_t(SumChannel::OpticalDepth)] = kDepthDigits;
  layout.first = frame.firstSeen;
  layout.extent = frame.seenExtent;
  return layout;
}

PartCells partCells(const GatherVolume::BrickCells& cells, const std::vector<shader::GatherLevel>& levels, const SharePart& part) {
  PartCells result{.numbers = cells.numbers, .skips = {}};
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const glm::ivec3 size = cells.bricks[level];
    const auto numberAt = [&](glm::ivec3 cell) -> std::uint32_t& {
      return result.numbers[std::size_t(levels[level].firstCell) + std::size_t(cell.x) +
                            std::size_t(size.x) * (std::size_t(cell.y) + std::size_t(size.y) * std::size_t(cell.z))];
    };
    std::vector<glm::ivec3> bricks;
    forEachCell(size, [&](glm::ivec3 cell) {
      if (numberAt(cell) != 0) bricks.push_back(cell);
    });
    for (const auto& [position, cell] : chunkPositions(bricks, size))
      if (part.holds(shareOf(position))) numberAt(cell) |= shader::kOwnBrick;

    Cells met = cells.met[level], own(met.dimensions);
    const int edge = cells.cellsPerBrick[level];
    forEachCell(met.dimensions, [&](glm::ivec3 cell) { own.values[own.index(cell)] = (numberAt(cell / edge) & shader::kOwnBrick) != 0; });
    own = spread(own, 0, 1);
    for (std::size_t i = 0; i < met.values.size(); ++i) met.values[i] = met.values[i] != 0 && own.values[i] != 0;
    const Cells skips = groupsToSkip(met);
    result.skips.insert(result.skips.end(), skips.values.begin(), skips.values.end());
  }
  return result;
}

GatherPartPass::GatherPartPass(const Device& device)
    : device_(device), rays_(device, "eye rays"), overflow_(device, sizeof(std::uint32_t), MemoryUse::Device, "overflow of sums") {}

void GatherPartPass::choose(const GatherVolume& volume, const SharePart& part) {
  if (part_ == part) return;
  part_.reset();
  const PartCells cells = partCells(volume.cells(), volume.levels(), part);
  std::tie(numbers_, numberTexels_) =
      uploadTexels(device_, std::as_bytes(std::span(cells.numbers)), VK_FORMAT_R32_UINT, "brick numbers of a part");
  std::tie(skips_, skipTexels_) =
      uploadTexels(device_, std::as_bytes(std::span(cells.skips)), VK_FORMAT_R8_UINT, "cells that a part skips");
  part_ = part;
}

void GatherPartPass::makeRoom() {
  const std::uint64_t bytes = layout_.pixelCount() * kSumChannels * sizeof(std::int64_t);
  if (sums_.bytes() >= bytes) return;
  sums_ = {};  // not both at once
  sums_ = Buffer(device_, bytes, MemoryUse::Device, "fixed-point sums");
}

void GatherPartPass::record(Commands& commands, GatherPass& gather, const GatherVolume& volume, const DeviceVolume& onDevice,
                            const shader::GatherFrame& frame, const RaySource& eye, const SharePart& part, FixedSums layout) {
  choose(volume, part);
  layout_ = partSums(frame, volume.hasScalars(), std::move(layout));
  makeRoom();

  rays_.record(commands, onDevice, eye, volume.hasScalars());
  shader::GatherFrame whole = frame;
  const auto digits = [&](SumChannel channel) { return layout_.digits[std::size_t(channel)]; };
  whole.part = {.sums = addressWords(sums_.address()),
                .overflow = addressWords(overflow_.address()),
                .colorDigits = digits(SumChannel::Red),
                .energyDigits = digits(SumChannel::Energy),
                .depthDigits = digits(SumChannel::OpticalDepth),
                .distanceDigits = digits(SumChannel::Distance)};
  std::ranges::copy(rays_.fans(), whole.part.fans);
  commands.clear(overflow_);
  commands.barrier(kComputeStage | VK_PIPELINE_STAGE_2_TRANSFER_BIT, kComputeStage);
  gather.recordPart(commands, volume, whole, numberTexels_, skipTexels_);
  commands.barrier(kComputeStage, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
}

FixedSums GatherPartPass::read() const {
  std::uint32_t overflow = 0;
  download(device_, overflow_, std::as_writable_bytes(std::span(&overflow, 1)));
  FV_CHECK_EQ(overflow, 0u);
  FixedSums sums = layout_;
  sums.values.resize(sums.pixelCount() * kSumChannels);
  download(device_, sums_, std::as_writable_bytes(std::span(sums.values)));
  return sums;
}

}  // namespace freevoxels
