#include "engine/splatting/share_list.h"

#include <algorithm>

#include "embedded/share_key.h"
#include "engine/core/error.h"
#include "engine/vulkan/commands.h"
#include "shaders/share_interface.h"

namespace freevoxels {

namespace {

static_assert(kShares == shader::kSortDigits, "share_key.comp counts a share a thread");

constexpr int kShareBits = 2 * shader::kSortBits;  // one digit and a spare one: an even number of passes sorts in place
constexpr std::uint64_t kCountBytes = kShares * sizeof(std::uint32_t);

/// The blocks that cover chunks, by level; other levels are left empty.
std::vector<std::vector<std::uint32_t>> coveringBlocks(const Device& device, const BuiltVolume& built) {
  const HierarchyLayout& hierarchy = built.volume.hierarchy;
  std::vector<std::vector<std::uint32_t>> blocks(hierarchy.levels.size());
  for (int level = chunkLevel(hierarchy, 0); level <= hierarchy.top(); ++level)
    blocks[std::size_t(level)] = downloadBlockList(device, built.lists.of(level, built.visible));
  return blocks;
}

shader::ShareFrame shareFrame(const DeviceVolume& volume, const ChunkShares& dealt) {
  shader::ShareFrame frame{};
  frame.levelCount = int(volume.hierarchy.levels.size());
  frame.chunkLevels = kChunkLevels;
  for (int level = 0; level < frame.levelCount; ++level) {
    frame.levels[level] = volume.onDevice(level);
    frame.firstChunks[level] = dealt.first[std::size_t(level)];
  }
  return frame;
}

}  // namespace

ShareList::ShareList(const Device& device, const BuiltVolume& built)
    : device_(device),
      built_(built),
      dealt_(dealChunks(built.volume.hierarchy, coveringBlocks(device, built))),
      keys_(makeComputePipeline(device, shaders::share_key)),
      sort_(device),
      frame_(device, sizeof(shader::ShareFrame), MemoryUse::Device, "share frame"),
      counts_(device, kCountBytes, MemoryUse::Device, "blocks of shares") {
  shares_ = Buffer(device, std::max<std::uint64_t>(dealt_.shares.size(), 1) * sizeof(std::uint32_t), MemoryUse::Device, "shares");
  if (!dealt_.shares.empty()) upload(device, shares_, std::as_bytes(std::span(dealt_.shares)));
  const shader::ShareFrame frame = shareFrame(built.volume, dealt_);
  upload(device, frame_, std::as_bytes(std::span(&frame, 1)));
}

void ShareList::makeRoom(std::uint64_t blocks) {
  if (pairs_.capacity >= blocks && pairs_.capacity > 0) return;
  pairs_ = {};  // not both at once
  pairs_ = makeSortPairs(device_, blocks);
}

const CutCandidates* ShareList::candidates(const SharePart& part) {
  if (part.count == 1) return nullptr;
  if (!candidates_) candidates_.emplace(device_, built_, dealt_);
  return &candidates_->of(part);
}

void ShareList::record(Commands& commands, const DeviceVolume& volume, const BlockList& drawn, std::uint64_t mostBlocks,
                       std::optional<int> wholeLevel) {
  if (wholeLevel && wholeLevel == groupedLevel_) return;
  groupedLevel_.reset();  // until the commands are done
  recordedLevel_ = wholeLevel;
  makeRoom(mostBlocks);
  const std::array<Binding, 9> bindings{&frame_,       &drawn.indices, &drawn.chunks,  &volume.occupancy, &shares_,
                                        &pairs_.count, &pairs_.keys,   &pairs_.values, &counts_};
  commands.beginPass("shares");
  commands.clear(counts_);
  // Also without blocks: the first invocation writes the number of pairs, which the sort reads.
  commands.dispatchLinear(keys_, bindings, shader::ShareKeyPush{drawn.chunkCount}, std::max<std::uint64_t>(mostBlocks, 1));
  commands.barrier(kComputeStage, kComputeStage);
  sort_.record(commands, pairs_, kShareBits);
}

void ShareList::select(const SharePart& part) {
  groupedLevel_ = recordedLevel_;
  std::array<std::uint32_t, kShares> counts{};
  download(device_, counts_, std::as_writable_bytes(std::span(counts)));
  chunksOfShares_.clear();
  std::vector<shader::ChunkArguments> chunks;
  std::uint32_t first = 0;
  for (int share = 0; share < kShares; ++share) {
    const std::uint32_t end = first + counts[std::size_t(share)];
    const std::size_t before = chunks.size();
    if (part.holds(share))
      for (std::uint32_t start = first; start < end; start += shader::kSplatsPerChunk)
        chunks.push_back(drawArguments(start, std::min(end - start, std::uint32_t(shader::kSplatsPerChunk))));
    if (chunks.size() > before) chunksOfShares_.push_back(std::uint32_t(chunks.size() - before));
    first = end;
  }
  selected_.chunkCount = std::uint32_t(chunks.size());
  if (chunks.empty()) return;
  selected_.chunks = Buffer(device_, chunks.size() * sizeof(shader::ChunkArguments), MemoryUse::Device, "chunk arguments of shares",
                           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  upload(device_, selected_.chunks, std::as_bytes(std::span(chunks)));
}

}  // namespace freevoxels
