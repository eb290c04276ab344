#include "engine/piece_tree.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>
#include <tuple>

#include "engine/core/error.h"

namespace freevoxels {

/// The bricks of a node of the grid, in bricks.
struct PieceTree::Part {
  glm::ivec3 node, first, end;
  std::size_t count = 0;
};

namespace {

/// Where parts are cut: the first part behind the plane, in the order of their beginnings along the axis.
struct Cut {
  int axis = 0;
  std::size_t part = 0;
};

template <typename Part>
void sortAlong(std::span<Part> parts, int axis) {
  std::ranges::sort(parts, {}, [axis](const Part& part) { return std::tuple(part.first[axis], part.first.z, part.first.y, part.first.x); });
}

/// Calls `visit(part, gap)` for each plane that cuts no part, with the width of the gap there. Parts are sorted along the axis.
template <typename Part, typename Visit>
void forEachGap(std::span<const Part> parts, int axis, const Visit& visit) {
  int end = parts.front().end[axis];
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i].first[axis] >= end) visit(i, parts[i].first[axis] - end);
    end = std::max(end, parts[i].end[axis]);
  }
}

/// The cut nearest to the middle of the parts: in a gap if there is one, else where parts touch. There is one, as nodes of a grid do not
/// overlap.
template <typename Part>
Cut bestCut(std::span<Part> parts) {
  Cut best;
  std::tuple<bool, std::size_t> least{true, std::numeric_limits<std::size_t>::max()};
  for (int axis = 0; axis < 3; ++axis) {
    sortAlong(parts, axis);
    forEachGap(std::span<const Part>(parts), axis, [&](std::size_t part, int gap) {
      const std::tuple rank(gap == 0, std::size_t(std::abs(std::ptrdiff_t(2 * part) - std::ptrdiff_t(parts.size()))));
      if (rank >= least) return;
      least = rank;
      best = {.axis = axis, .part = part};
    });
  }
  FV_CHECK_LT(std::size_t(0), best.part);
  return best;
}

}  // namespace

PieceTree::PieceTree(const SparseGrid<std::uint8_t>& bricks, glm::ivec3 dimensions) {
  using Bricks = SparseGrid<std::uint8_t>;
  std::vector<Part> parts;
  bricks.forEach([&](glm::ivec3 brick, std::uint8_t) {  // node by node
    const glm::ivec3 node = brick / Bricks::kNodeEdge;
    if (parts.empty() || parts.back().node != node) parts.push_back({.node = node, .first = brick, .end = brick + 1});
    Part& part = parts.back();
    part.first = glm::min(part.first, brick);
    part.end = glm::max(part.end, brick + 1);
    ++part.count;
  });
  if (!parts.empty()) add(parts, dimensions);
}

int PieceTree::add(std::span<Part> parts, glm::ivec3 dimensions) {
  Part all = parts.front();
  for (const Part& part : parts.subspan(1)) {
    all.first = glm::min(all.first, part.first);
    all.end = glm::max(all.end, part.end);
    all.count += part.count;
  }
  const VoxelRange voxels{all.first * ScalarBricks::kEdge, glm::min(all.end * ScalarBricks::kEdge, dimensions)};
  const glm::ivec3 edges = voxels.extent();
  const int number = int(nodes_.size());
  nodes_.emplace_back();
  if (parts.size() == 1 || (all.count <= kMostBricks && std::max({edges.x, edges.y, edges.z}) <= kLongestEdge)) {
    nodes_.back().piece = pieces_.size();
    pieces_.push_back(voxels);
    return number;
  }
  const Cut cut = bestCut(parts);
  sortAlong(parts, cut.axis);
  const int at = parts[cut.part].first[cut.axis] * ScalarBricks::kEdge;
  const int low = add(parts.first(cut.part), dimensions), high = add(parts.subspan(cut.part), dimensions);
  nodes_[std::size_t(number)] = {.axis = cut.axis, .at = at, .low = low, .high = high};
  return number;
}

std::vector<VoxelRange> PieceTree::inOrder(const RaySource& eye) const {
  std::vector<VoxelRange> ordered;
  std::vector<int> open;
  if (!nodes_.empty()) open.push_back(0);
  while (!open.empty()) {
    const Node& node = nodes_[std::size_t(open.back())];
    open.pop_back();
    if (node.low < 0) {
      ordered.push_back(pieces_[node.piece]);
      continue;
    }
    const bool isLowFirst = eye.atInfinity ? !(eye.place[node.axis] > 0.0) : eye.place[node.axis] < double(node.at);
    open.push_back(isLowFirst ? node.high : node.low);
    open.push_back(isLowFirst ? node.low : node.high);
  }
  return ordered;
}

}  // namespace freevoxels
