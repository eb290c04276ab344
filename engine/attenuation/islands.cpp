#include "engine/attenuation/islands.h"

#include <algorithm>
#include <limits>

namespace freevoxels {

namespace {

constexpr int kNode = SparseGrid<std::uint8_t>::kNodeEdge;

/// From brick `low` to `high`, inclusive.
struct BrickBox {
  glm::ivec3 low{std::numeric_limits<int>::max()}, high{std::numeric_limits<int>::min()};

  void add(const BrickBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool overlaps(const BrickBox& other) const {
    return glm::all(glm::lessThanEqual(low, other.high)) && glm::all(glm::lessThanEqual(other.low, high));
  }
};

/// The marked bricks of a node.
struct NodeBox {
  glm::ivec3 place{0};
  BrickBox bricks;
};

std::vector<NodeBox> nodesOf(const SparseGrid<std::uint8_t>& bricks) {
  std::vector<NodeBox> nodes;
  for (const glm::ivec3 place : bricks.places()) nodes.push_back({.place = place, .bricks = {}});
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const glm::ivec3 first = nodes[node].place * kNode;
    for (int i = 0; i < kNode * kNode * kNode; ++i)
      if (bricks.nodes()[node][std::size_t(i)] != 0) {
        const glm::ivec3 brick = first + glm::ivec3(i % kNode, i / kNode % kNode, i / (kNode * kNode));
        nodes[node].bricks.add({brick, brick});
      }
  }
  std::erase_if(nodes, [](const NodeBox& node) { return node.bricks.low.x > node.bricks.high.x; });
  return nodes;
}

/// The boxes around nodes that are connected through neighbours, in cells of 2^shift nodes along an edge.
std::vector<BrickBox> connected(const std::vector<NodeBox>& nodes, glm::ivec3 dimensions, int shift) {
  SparseGrid<std::uint32_t> islands((dimensions >> shift) + 1);  // number of each cell's island, from 1; or of those to come, kOpen
  constexpr std::uint32_t kOpen = std::numeric_limits<std::uint32_t>::max();
  for (const NodeBox& node : nodes) islands[node.place >> shift] = kOpen;
  std::vector<BrickBox> boxes;
  std::vector<glm::ivec3> next;
  const auto take = [&](glm::ivec3 cell) {
    if (islands.at(cell) != kOpen) return;
    islands[cell] = std::uint32_t(boxes.size());
    next.push_back(cell);
  };
  for (const NodeBox& node : nodes) {
    if (islands.at(node.place >> shift) != kOpen) continue;
    boxes.emplace_back();
    for (take(node.place >> shift); !next.empty();) {
      const glm::ivec3 cell = next.back();
      next.pop_back();
      const glm::ivec3 low = glm::max(cell - 1, 0), high = glm::min(cell + 1, islands.dimensions() - 1);
      for (glm::ivec3 beside = low; beside.z <= high.z; ++beside.z)
        for (beside.y = low.y; beside.y <= high.y; ++beside.y)
          for (beside.x = low.x; beside.x <= high.x; ++beside.x) take(beside);
    }
  }
  for (const NodeBox& node : nodes) boxes[islands.at(node.place >> shift) - 1].add(node.bricks);
  return boxes;
}

/// Joins boxes until none overlaps another.
void join(std::vector<BrickBox>& boxes) {
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t j = i + 1; j < boxes.size();) {
        if (!boxes[i].overlaps(boxes[j])) {
          ++j;
          continue;
        }
        boxes[i].add(boxes[j]);
        boxes[j] = boxes.back();
        boxes.pop_back();
        changes = true;
      }
  }
}

}  // namespace

std::vector<VoxelRange> islandsOf(const SparseGrid<std::uint8_t>& bricks, glm::ivec3 dimensions) {
  const std::vector<NodeBox> nodes = nodesOf(bricks);
  std::vector<BrickBox> boxes = connected(nodes, bricks.dimensions() / kNode, 0);
  for (int shift = 1; boxes.size() > kMaxIslands; ++shift) boxes = connected(nodes, bricks.dimensions() / kNode, shift);
  join(boxes);
  std::vector<VoxelRange> islands;
  for (const BrickBox& box : boxes)
    islands.push_back({.first = box.low * ScalarBricks::kEdge, .end = glm::min((box.high + 1) * ScalarBricks::kEdge, dimensions)});
  return islands;
}

}  // namespace freevoxels
