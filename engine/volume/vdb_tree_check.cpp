// File layout: OpenVDB's tree/RootNode.h, InternalNode.h, LeafNode*.h (readTopology, readBuffers) and
// io/Compression.h (readCompressedValues), format versions 222 (2013) and later.
#include "engine/volume/vdb_tree_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string_view>
#include <vector>

namespace freevoxels {

namespace {

enum Compression : std::uint32_t { kZip = 1, kActiveMask = 2, kBlosc = 4 };

struct ValueLayout {
  std::string_view treeType;
  std::uint32_t bytes;          ///< of one value
  std::uint32_t halfBytes;      ///< bytes of one value in a list that is saved as half
  std::uint32_t leafBytes = 0;  ///< bytes behind the mask of a leaf; 0 if a list of values follows
};

constexpr ValueLayout kLayouts[] = {
    {"Tree_float_5_4_3", 4, 2},  {"Tree_double_5_4_3", 8, 2},        {"Tree_int32_5_4_3", 4, 4},
    {"Tree_int64_5_4_3", 8, 8},  {"Tree_vec3i_5_4_3", 12, 12},       {"Tree_vec3s_5_4_3", 12, 6},
    {"Tree_vec3d_5_4_3", 24, 6}, {"Tree_bool_5_4_3", 1, 1, 12 + 64}, {"Tree_mask_5_4_3", 1, 1, 12}};

constexpr int kMaxNode = 5, kLeaf = 3;  // log2 of children along an edge
constexpr std::int32_t kRootCell = 1 << (5 + 4 + 3);

template <int Log2>
using Mask = std::array<std::uint64_t, (1u << (3 * Log2)) / 64>;
using MaskView = std::span<const std::uint64_t>;

std::uint64_t countOn(MaskView mask) {
  std::uint64_t count = 0;
  for (const std::uint64_t word : mask) count += std::uint64_t(std::popcount(word));
  return count;
}

class TreeCheck {
 public:
  TreeCheck(VdbReader& reader, const VdbHeader::Grid& grid, const ValueLayout& layout, const Progress& progress)
      : reader_(reader),
        layout_(layout),
        compression_(grid.compression),
        isHalf_(grid.valuesAreHalf && layout.halfBytes != layout.bytes),
        progress_(progress) {}

  void check() {
    if (compression_ > (kZip | kActiveMask | kBlosc))
      reader_.failDamaged("it has the unknown compression {}", compression_);
    reader_.skip(sizeof(std::int32_t));  // number of buffers, always 1
    checkRoot();
    for (const Mask<kLeaf>& mask : leaves_) checkLeaf(mask);
  }

 private:
  using Cell = std::array<std::int32_t, 3>;

  void checkRoot() {
    reader_.skip(layout_.bytes);  // background
    const auto tiles = reader_.read<std::uint32_t>();
    const auto children = reader_.read<std::uint32_t>();
    for (std::uint32_t i = 0; i < tiles; ++i) {
      readCell();
      reader_.skip(layout_.bytes + 1);  // value, and whether it is active
    }
    Cell previous{};
    for (std::uint32_t i = 0; i < children; ++i) {
      const Cell cell = readCell();
      // OpenVDB sorts the children, and reads their leaves in that order.
      if (i > 0 && !(previous < cell)) reader_.failDamaged("the nodes of a tree are out of order");
      previous = cell;
      checkNode<kMaxNode>();
    }
  }

  Cell readCell() {
    const Cell cell = reader_.read<Cell>();
    for (const std::int32_t coordinate : cell)
      if (coordinate % kRootCell != 0)
        reader_.failDamaged("a node of a tree is at {} {} {}", cell[0], cell[1], cell[2]);
    return cell;
  }

  template <int Log2>
  void checkNode() {
    const auto children = reader_.read<Mask<Log2>>();
    const auto active = reader_.read<Mask<Log2>>();
    for (std::size_t i = 0; i < children.size(); ++i)
      if (children[i] & active[i]) reader_.failDamaged("a node of a tree has children in place of values");
    checkValues(active);
    const std::uint64_t childCount = countOn(children);
    for (std::uint64_t i = 0; i < childCount; ++i)
      if constexpr (Log2 - 1 == kLeaf)
        leaves_.push_back(reader_.read<Mask<kLeaf>>());
      else
        checkNode<Log2 - 1>();
  }

  void checkLeaf(const Mask<kLeaf>& mask) {
    constexpr std::size_t kInterval = 4096;  // leaves
    if (progress_ && leavesChecked_++ % kInterval == 0) progress_("checking the grid", double(leavesChecked_) / double(leaves_.size()));
    if (reader_.read<Mask<kLeaf>>() != mask) reader_.failDamaged("the masks of a leaf differ");
    if (layout_.leafBytes > 0)
      reader_.skip(layout_.leafBytes);
    else
      checkValues(mask);
  }

  /// Checks a list of values, one for each bit of the mask, or for each bit that is on.
  void checkValues(MaskView active) {
    // How inactive values are stored: +-background, one value, two values, or two values and a mask that
    // chooses between them.
    enum Inactive : std::uint8_t {
      kOneValue = 2,
      kMask = 3,
      kMaskAndOne = 4,
      kMaskAndTwo = 5,
      kAllStored = 6
    };
    const auto inactive = reader_.read<std::uint8_t>();
    if (inactive > kAllStored) reader_.failDamaged("a node of a tree has the unknown layout {}", inactive);
    if (inactive == kOneValue || inactive == kMaskAndOne) reader_.skip(layout_.bytes);
    if (inactive == kMaskAndTwo) reader_.skip(2 * layout_.bytes);
    if (inactive >= kMask && inactive <= kMaskAndTwo) reader_.skip(active.size_bytes());
    const bool isSparse = (compression_ & kActiveMask) && inactive != kAllStored;
    const std::uint64_t count = isSparse ? countOn(active) : 64 * active.size();
    if (isHalf_ && count == 0) return;  // OpenVDB also leaves out the size
    skipChunk(count * (isHalf_ ? layout_.halfBytes : layout_.bytes));
  }

  void skipChunk(std::uint64_t bytes) {
    if (!(compression_ & (kZip | kBlosc))) return reader_.skip(bytes);
    const auto stored = reader_.read<std::int64_t>();  // negative if the values are not compressed
    if (stored <= 0 && stored != -std::int64_t(bytes))
      reader_.failDamaged("{} bytes are given as {}", bytes, stored);
    if (stored <= 0)
      reader_.skip(bytes);
    else if (compression_ & kBlosc)
      skipBlosc(reader_, std::uint64_t(stored), bytes);
    else
      reader_.skip(std::uint64_t(stored));
  }

  VdbReader& reader_;
  const ValueLayout& layout_;
  std::uint32_t compression_;
  bool isHalf_;
  const Progress& progress_;
  std::size_t leavesChecked_ = 0;
  std::vector<Mask<kLeaf>> leaves_;  // in the order of their values
};

}  // namespace

bool checkVdbTree(VdbReader& reader, const VdbHeader::Grid& grid, const Progress& progress) {
  const auto layout = std::ranges::find(kLayouts, grid.type, &ValueLayout::treeType);
  if (layout == std::end(kLayouts) || grid.treeStart == 0) return false;
  reader.seek(grid.treeStart);
  TreeCheck(reader, grid, *layout, progress).check();
  return true;
}

}  // namespace freevoxels
