// The part of GatherVolume that allocates: room for bricks and their quads, and what is kept of them for another transfer function.

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/gathering/gather_volume.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

constexpr const char* kMediumQuads = "medium quads";

}  // namespace

/// Finds the bricks. With more of them than there is room for, room is made for some more than these.
void GatherVolume::include(const Cells& met, std::vector<StageTime>& times) {
  const StageTimer timer(times, "bricks");
  bricks_.include(met);
  if (bricks_.count() <= capacity_) return;
  capacity_ = capacity_ == 0 ? bricks_.count() : bricks_.count() + bricks_.count() / 4;
  const std::uint64_t quads = std::uint64_t(capacity_) * shader::kGatherBrickBlocks;
  inPieces_ = quads > device_.limits().maxTexelBufferElements || quads * sizeof(glm::uvec4) > device_.maximumAllocation();
  bricksPerPiece_ = inPieces_ ? 1u << shader::kPieceBricksLog2 : capacity_;
  if (capacity_ > std::uint64_t(bricksPerPiece_) * shader::kMaxPieces)
    fail(ErrorKind::OutOfMemory, "the gather needs {} quads of voxels, more than the {} that it can number: use {}", quads,
         std::uint64_t(bricksPerPiece_) * shader::kMaxPieces * shader::kGatherBrickBlocks, Parameter("draw", "splats"));
}

void GatherVolume::reclassify(const Cells& met, std::vector<StageTime>& times) {
  FV_CHECK_EQ(hasScalars() && surroundings_ == nullptr, true);
  const std::uint32_t before = capacity_, bricks = bricks_.count();
  const bool wasInPieces = inPieces_;
  include(met, times);
  sources_ = {};  // of as many blocks as there were
  extras_ = {};
  if (inPieces_ || wasInPieces) {
    quads_ = {};
    lightCodes_ = {};
    gradients_ = {};
    gradientTexels_ = {};
    shadedLevels_ = 0;
    lightMade_ = gradientsMade_ = {};
    return;
  }
  // What is made of voxels' codes stays. Blocks above them are others, and their quads, too.
  shadedLevels_ = 0;
  for (GatherBricks::Made* const made : {&lightMade_, &gradientsMade_, &quads_[0].made, &quads_[1].made, &quads_[2].made})
    made->levels &= 1;
  if (lit_)  // their quads have source terms
    for (Quads& quads : quads_) quads.made = {};
  // The light at the sides of a brick is that of its neighbours, which may be new.
  for (Quads& quads : quads_) {
    quads.lightMade.levels &= 1;
    if (bricks_.count() > bricks) quads.lightMade = {};
  }
  if (capacity_ > before) enlarge();
}

/// Moves what is made of bricks to buffers with room for all of them.
void GatherVolume::enlarge() {
  for (Quads& quads : quads_) {
    if (quads.made.levels == 0) continue;
    QuadStore larger;
    larger.pieces.push_back(enlarged(quads.medium.pieces.front(), quads.made, sizeof(glm::uvec2), kMediumQuads));
    quads.medium = {};
    if (quads.made.levels == 0) continue;
    larger.texels = TexelView(device_, larger.pieces.front(), VK_FORMAT_R32G32_UINT);
    quads.medium = std::move(larger);
  }
  for (Buffer& codes : lightCodes_) codes = enlarged(codes, lightMade_, sizeof(std::uint16_t), kLightCodes);
  gradients_ = enlarged(gradients_, gradientsMade_, sizeof(std::uint32_t), kGradients);
  viewGradients();
}

/// A larger buffer with the bytes of one that is given up. None if it was empty, or if there is not enough memory: what is there is then to
/// be made again.
Buffer GatherVolume::enlarged(const Buffer& buffer, GatherBricks::Made& made, std::uint64_t blockBytes, const char* name) const {
  if (made.levels == 0 || buffer.bytes() == 0) return {};
  try {
    Buffer larger(device_, capacity_ * shader::kGatherBrickBlocks * blockBytes, MemoryUse::Device, name,
                  VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
    Commands commands(device_);
    commands.copy(buffer, larger, {.srcOffset = 0, .dstOffset = 0, .size = buffer.bytes()});
    commands.submitAndWait();
    return larger;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::OutOfMemory) throw;
    made = {};
    return {};
  }
}

std::uint64_t GatherVolume::Quads::bytes() const {
  std::uint64_t sum = medium.bytes() + source.bytes() + extra.bytes();
  for (const QuadStore& store : light) sum += store.bytes();
  return sum;
}

/// Frees quads that are out of date, and then those beyond `most` bytes.
void GatherVolume::dropOtherAxes(const std::array<bool, 3>& axes, std::uint64_t most) {
  std::uint64_t kept = 0;
  for (std::size_t axis = 0; axis < quads_.size(); ++axis) {
    Quads& quads = quads_[axis];
    if (axes[axis]) continue;
    kept += quads.bytes();
    if (quads.made.levels == 0 || kept > most) quads = {};
  }
}

std::uint64_t GatherVolume::QuadStore::bytes() const {
  std::uint64_t sum = 0;
  for (const Buffer& piece : pieces) sum += piece.bytes();
  return sum;
}

/// A minimal store for quads that are not needed, because a binding needs a buffer.
GatherVolume::QuadStore GatherVolume::makeStore(bool needed, std::uint64_t quadBytes, VkFormat format, const char* name) const {
  QuadStore store;
  for (std::uint32_t first = 0; first == 0 || (needed && first < capacity_); first += bricksPerPiece_) {
    const std::uint64_t quads = std::uint64_t(std::min(bricksPerPiece_, capacity_ - first)) * shader::kGatherBrickBlocks;
    store.pieces.emplace_back(device_, (needed ? quads : 1) * quadBytes, MemoryUse::Device, name, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  }
  store.texels = TexelView(device_, store.pieces.front(), format, inPieces_ ? quadBytes : VK_WHOLE_SIZE);
  return store;
}

/// Reuses the memory of an axis whose quads are out of date, if there is one.
void GatherVolume::makeRoom(Quads& quads, const std::array<bool, 3>& axes) {
  struct Need {
    QuadStore& store;
    bool needed;
    std::uint64_t bytes;
    VkFormat format;
    const char* name;
    GatherBricks::Made& made;
  };
  const auto needsOf = [&](Quads& there) {
    std::vector<Need> needs{
        {there.medium, true, sizeof(glm::uvec2), VK_FORMAT_R32G32_UINT, kMediumQuads, there.made},
        {there.source, hasColors(), sizeof(glm::uvec4), VK_FORMAT_R32G32B32A32_UINT, "source quads", there.made},
        {there.extra, hasTowards() || hasEmissionApart(), sizeof(glm::uvec4), VK_FORMAT_R32G32B32A32_UINT, "extra quads", there.made}};
    for (std::size_t i = 0; i < there.light.size(); ++i)
      needs.push_back(
          {there.light[i], i < std::size_t(sampleLights()), sizeof(glm::uvec2), VK_FORMAT_R32G32_UINT, "light quads", there.lightMade});
    return needs;
  };
  const std::uint64_t count = std::uint64_t(bricks_.count()) * shader::kGatherBrickBlocks;
  const auto isMet = [&](const Need& need) { return need.store.bytes() >= (need.needed ? count : 1) * need.bytes; };
  if (std::ranges::all_of(needsOf(quads), isMet)) return;
  for (std::size_t other = 0; other < axes.size() && quads.made.levels == 0; ++other) {
    if (axes[other] || quads_[other].made.levels != 0 || !std::ranges::all_of(needsOf(quads_[other]), isMet)) continue;
    quads = std::exchange(quads_[other], {});
    return;
  }
  for (const Need& need : needsOf(quads)) {
    if (isMet(need)) continue;
    need.made = {};
    need.store = {};  // not both at once
    need.store = makeStore(need.needed, need.bytes, need.format, need.name);
  }
}

}  // namespace freevoxels
