#include "engine/splatting/share_candidates.h"

#include <algorithm>
#include <array>
#include <bit>

#include "engine/octree/block_list.h"

namespace freevoxels {

namespace {

static_assert(kShares == 256, "a share fits a byte");

int bitOf(glm::ivec3 cell) {
  return (cell.x & 1) + 2 * (cell.y & 1) + 4 * (cell.z & 1);
}

std::size_t placeOf(const std::vector<std::uint32_t>& blocks, std::uint32_t block) {
  return std::size_t(std::ranges::lower_bound(blocks, block) - blocks.begin());
}

Buffer uploaded(const Device& device, const std::vector<std::uint32_t>& values, const char* name) {
  Buffer buffer(device, std::max<std::size_t>(values.size(), 1) * sizeof(std::uint32_t), MemoryUse::Device, name);
  upload(device, buffer, std::as_bytes(std::span(values)));
  return buffer;
}

}  // namespace

ShareCandidates::ShareCandidates(const Device& device, const BuiltVolume& built, const ChunkShares& dealt)
    : device_(device), hierarchy_(built.volume.hierarchy) {
  for (const BlockList& list : built.lists.coarse) levels_.push_back({.blocks = downloadBlockList(device, list), .shares = {}});
  for (int level = 1; level <= hierarchy_.top(); ++level) {
    Level& parents = levels_[std::size_t(level) - 1];
    const int covering = chunkLevel(hierarchy_, level - 1);
    const std::vector<std::uint32_t>& chunks = levels_[std::size_t(covering) - 1].blocks;
    parents.shares.reserve(parents.blocks.size());
    std::uint32_t chunk = 0, before = 0;
    for (const std::uint32_t block : parents.blocks) {
      const std::uint32_t cover = hierarchy_.indexOf({covering, hierarchy_.blockAt(block).cell >> (covering - level)});
      if (parents.shares.empty() || cover != before) chunk = dealt.first[std::size_t(level) - 1] + std::uint32_t(placeOf(chunks, cover));
      before = cover;
      parents.shares.push_back(std::uint8_t(dealt.shares[chunk]));
    }
  }
}

std::vector<std::uint8_t> ShareCandidates::wantedChildren(const Level& level, const SharePart& part,
                                                          const std::vector<std::uint32_t>& below) const {
  std::array<std::uint8_t, kShares> ofShare{};
  for (int share = 0; share < kShares; ++share) ofShare[std::size_t(share)] = part.holds(share) ? 255 : 0;
  std::vector<std::uint8_t> wanted(level.blocks.size());
  std::ranges::transform(level.shares, wanted.begin(), [&](std::uint8_t share) { return ofShare[share]; });
  for (const std::uint32_t index : below) {
    const Block block = hierarchy_.blockAt(index);
    wanted[placeOf(level.blocks, hierarchy_.indexOf(block.parent()))] |= std::uint8_t(1 << bitOf(block.cell));
  }
  return wanted;
}

const CutCandidates& ShareCandidates::of(const SharePart& part) {
  if (part == part_) return candidates_;
  candidates_.levels.clear();
  std::vector<std::uint32_t> parents;
  for (const Level& level : levels_) {
    const std::vector<std::uint8_t> wanted = wantedChildren(level, part, parents);
    parents.clear();
    std::vector<std::uint32_t> children;
    CutCandidates::Level& candidates = candidates_.levels.emplace_back();
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i] == 0) continue;
      parents.push_back(level.blocks[i]);
      children.push_back(wanted[i]);
      candidates.mostBlocks += std::uint64_t(std::popcount(wanted[i]));
    }
    candidates.parentCount = std::uint32_t(parents.size());
    candidates.parents = uploaded(device_, parents, "parents of a part");
    candidates.children = uploaded(device_, children, "children of a part");
  }
  part_ = part;
  return candidates_;
}

}  // namespace freevoxels
