// Pieces of volumes: what they contain, how large they are, and their order before an eye.

#include "engine/piece_tree.h"

#include <gtest/gtest.h>

#include <random>

namespace freevoxels {
namespace {

using Bricks = SparseGrid<std::uint8_t>;

constexpr int kBrick = ScalarBricks::kEdge;

void fillBox(Bricks& bricks, glm::ivec3 first, glm::ivec3 end) {
  for (glm::ivec3 v = first; v.z < end.z; ++v.z)
    for (v.y = first.y; v.y < end.y; ++v.y)
      for (v.x = first.x; v.x < end.x; ++v.x) bricks[v] = 1;
}

/// Fails unless each brick is in exactly one piece.
void expectAllBricksOnce(const PieceTree& tree, const Bricks& bricks) {
  bricks.forEach([&](glm::ivec3 cell, std::uint8_t) {
    const auto holds = [&](const VoxelRange& piece) {
      const glm::ivec3 voxel = cell * kBrick;
      return glm::all(glm::greaterThanEqual(voxel, piece.first)) && glm::all(glm::lessThan(voxel, piece.end));
    };
    EXPECT_EQ(std::ranges::count_if(tree.pieces(), holds), 1) << cell.x << ' ' << cell.y << ' ' << cell.z;
  });
}

/// Boxes of random sizes, some of which touch.
Bricks randomBoxes(unsigned seed, glm::ivec3 cells) {
  Bricks bricks(cells);
  std::mt19937 random(seed);
  for (int i = 0; i < 40; ++i) {
    glm::ivec3 first, end;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = int(random() % unsigned(cells[axis]));
      end[axis] = std::min(first[axis] + 1 + int(random() % 11), cells[axis]);
    }
    fillBox(bricks, first, end);
  }
  return bricks;
}

TEST(PieceTree, PiecesHoldEachBrickOnceAndAreSmall) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const glm::ivec3 cells(97, 64, 41), voxels = cells * kBrick - 3;
    const Bricks bricks = randomBoxes(seed, cells);
    const PieceTree tree(bricks, voxels);
    expectAllBricksOnce(tree, bricks);
    for (const VoxelRange& piece : tree.pieces())
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(piece.extent()[axis], PieceTree::kLongestEdge);
        EXPECT_LE(piece.end[axis], voxels[axis]);
        EXPECT_EQ(piece.first[axis] % kBrick, 0);
      }
  }
}

TEST(PieceTree, AnIslandAcrossNodesIsOnePiece) {
  Bricks bricks(glm::ivec3(125'000));
  for (const glm::ivec3 corner : {glm::ivec3(5, 6, 7), glm::ivec3(90'004, 77, 100'003), glm::ivec3(124'990, 124'990, 0)})
    fillBox(bricks, corner, corner + 9);
  const PieceTree tree(bricks, glm::ivec3(1'000'000));
  EXPECT_EQ(tree.pieces().size(), 3u);
  for (const VoxelRange& piece : tree.pieces()) EXPECT_EQ(piece.extent(), glm::ivec3(9 * kBrick));
}

TEST(PieceTree, DenseBricksAreCutIntoCubes) {
  Bricks bricks(glm::ivec3(32));
  fillBox(bricks, glm::ivec3(0), glm::ivec3(32));
  const PieceTree tree(bricks, glm::ivec3(32 * kBrick));
  EXPECT_EQ(tree.pieces().size(), 64u);
  for (const VoxelRange& piece : tree.pieces()) EXPECT_EQ(piece.extent(), glm::ivec3(PieceTree::kCubeEdge));
}

TEST(PieceTree, NoRayMeetsAPieceBeforeOneThatComesEarlier) {
  const glm::ivec3 cells(97, 64, 41);
  const PieceTree tree(randomBoxes(7, cells), cells * kBrick);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-300.0, 1000.0);
  for (int i = 0; i < 20; ++i) {
    const glm::dvec3 eye(place(random), place(random), place(random));
    const std::vector<VoxelRange> pieces = tree.inOrder({.place = eye, .atInfinity = false});
    ASSERT_EQ(pieces.size(), tree.pieces().size());
    for (int ray = 0; ray < 200; ++ray) {
      const glm::dvec3 way = glm::normalize(glm::dvec3(place(random), place(random), place(random)) - eye);
      double last = 0.0;
      for (const VoxelRange& piece : pieces) {
        const glm::dvec3 a = (glm::dvec3(piece.first) - eye) / way, b = (glm::dvec3(piece.end) - eye) / way;
        const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
        const double begin = std::max({low.x, low.y, low.z, 0.0}), end = std::min({high.x, high.y, high.z});
        if (begin >= end) continue;
        ASSERT_GE(begin, last - 1e-6);
        last = end;
      }
    }
  }
  for (const double side : {1.0, -1.0}) {
    const std::vector<VoxelRange> pieces = tree.inOrder({.place = {0.0, 0.0, side}, .atInfinity = true});
    for (std::size_t front = 0; front < pieces.size(); ++front)
      for (std::size_t back = front + 1; back < pieces.size(); ++back) {
        const VoxelRange &a = pieces[front], &b = pieces[back];
        if (glm::any(glm::lessThanEqual(glm::ivec2(a.end), glm::ivec2(b.first))) ||
            glm::any(glm::lessThanEqual(glm::ivec2(b.end), glm::ivec2(a.first))))
          continue;
        EXPECT_TRUE(side > 0.0 ? a.first.z >= b.end.z : a.end.z <= b.first.z) << "of an eye far away along z";
      }
  }
}

}  // namespace
}  // namespace freevoxels
