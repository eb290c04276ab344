#pragma once
// A value for each cell of a box of any size, of which only the neighbourhoods of those that were set take memory.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

namespace freevoxels {

/// Two levels: a table of nodes, and nodes of kNodeEdge^3 cells. The table has an entry for each node of a small box, and is a hash table
/// for a large one. Several threads may read.
template <typename Value>
class SparseGrid {
 public:
  static constexpr int kNodeEdge = 8;
  using Node = std::array<Value, std::size_t(kNodeEdge) * kNodeEdge * kNodeEdge>;  ///< x fastest

  SparseGrid() = default;
  /// Each cell has the value `empty`.
  explicit SparseGrid(glm::ivec3 dimensions, Value empty = {}) : dimensions_(dimensions), empty_(empty) {
    constexpr double kMaxEntries = 1 << 20;
    tableSize_ = nodeOf(dimensions + (kNodeEdge - 1));
    const bool isSmall = double(tableSize_.x) * double(tableSize_.y) * double(tableSize_.z) <= kMaxEntries;
    if (isSmall) table_.resize(std::size_t(tableSize_.x) * std::size_t(tableSize_.y) * std::size_t(tableSize_.z), kNone);
  }

  const glm::ivec3& dimensions() const { return dimensions_; }
  /// `cell` is in the box, here and below.
  const Value& at(glm::ivec3 cell) const {
    const std::uint32_t number = numberOf(nodeOf(cell));
    return number == kNone ? empty_ : nodes_[number][indexInNode(cell)];
  }
  /// A value that may be set. The reference is valid until the next call.
  Value& operator[](glm::ivec3 cell) {
    const glm::ivec3 node = nodeOf(cell);
    std::uint32_t& number = table_.empty() ? hashed_.try_emplace(node, kNone).first->second : table_[indexOf(node)];
    if (number == kNone) {
      number = std::uint32_t(nodes_.size());
      places_.push_back(node);
      nodes_.emplace_back().fill(empty_);
    }
    return nodes_[number][indexInNode(cell)];
  }

  /// The nodes that exist, in the order in which they were made: the places of their first cells over kNodeEdge, and their values.
  std::span<const glm::ivec3> places() const { return places_; }
  std::span<const Node> nodes() const { return nodes_; }
  /// Calls `visit(cell, value)` for the cells of existing nodes that are not empty.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (std::size_t node = 0; node < nodes_.size(); ++node)
      for (int i = 0; i < int(nodes_[node].size()); ++i)
        if (const Value& value = nodes_[node][std::size_t(i)]; value != empty_)
          visit(places_[node] * kNodeEdge + glm::ivec3(i % kNodeEdge, i / kNodeEdge % kNodeEdge, i / (kNodeEdge * kNodeEdge)), value);
  }
  /// Bytes that the grid takes on the host.
  std::uint64_t bytes() const {
    return table_.size() * sizeof(std::uint32_t) + nodes_.size() * (sizeof(Node) + sizeof(glm::ivec3)) +
           hashed_.size() * 2 * (sizeof(glm::ivec3) + sizeof(std::uint32_t));
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr int kShift = 3;
  static_assert(1 << kShift == kNodeEdge);

  static glm::ivec3 nodeOf(glm::ivec3 cell) { return cell >> kShift; }
  static std::size_t indexInNode(glm::ivec3 cell) {
    const glm::ivec3 place = cell & (kNodeEdge - 1);
    return std::size_t(place.x + kNodeEdge * (place.y + kNodeEdge * place.z));
  }
  std::size_t indexOf(glm::ivec3 node) const {
    return std::size_t(node.x) + std::size_t(tableSize_.x) * (std::size_t(node.y) + std::size_t(tableSize_.y) * std::size_t(node.z));
  }
  struct Hash {
    std::size_t operator()(glm::ivec3 node) const {
      std::uint64_t hash = 0;
      for (int axis = 0; axis < 3; ++axis) hash = (hash ^ std::uint32_t(node[axis])) * 0x9e3779b97f4a7c15u;
      return std::size_t(hash ^ hash >> 32);
    }
  };
  std::uint32_t numberOf(glm::ivec3 node) const {
    if (!table_.empty()) return table_[indexOf(node)];
    const auto found = hashed_.find(node);
    return found == hashed_.end() ? kNone : found->second;
  }

  glm::ivec3 dimensions_{0}, tableSize_{0};
  Value empty_{};
  std::vector<std::uint32_t> table_;                            ///< number of each node, kNone if it does not exist; empty for a large box
  std::unordered_map<glm::ivec3, std::uint32_t, Hash> hashed_;  ///< the same of existing nodes, for a large box
  std::vector<glm::ivec3> places_;
  std::vector<Node> nodes_;
};

}  // namespace freevoxels
