#pragma once
// The 3D Hilbert curve, along which chunks of a volume are stored and dealt to the shares of a distributed render: Subr et al. 2007,
// Sections 4.4 and 5. Cells that are near each other on the curve are near each other in space, so that a contiguous part of a file
// is a compact part of the volume.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace freevoxels {

/// Largest number of bits of a coordinate: an index has three times as many.
inline constexpr int kMaxHilbertBits = 21;

/// Position along the curve through the cube of 2^bits cells a side, 0 to 8^bits - 1. Each coordinate is
/// below 2^bits. Cells at consecutive positions share a face; the first 8^k positions fill a cube of 2^k
/// cells a side. After Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
std::uint64_t hilbertIndex(glm::uvec3 cell, int bits);
/// The cell at a position: the inverse of hilbertIndex.
glm::uvec3 hilbertCell(std::uint64_t index, int bits);

/// Least number of bits, at least 1, whose cube contains a box of these dimensions.
int hilbertBits(glm::ivec3 dimensions);

/// All cells of the box from (0,0,0) to `dimensions` - 1 in the order of the curve through the smallest cube that contains it. In a
/// box that is no such cube, consecutive cells need not be neighbours.
std::vector<glm::ivec3> hilbertOrder(glm::ivec3 dimensions);

/// The same of some cells of the box, each of which is there once.
void sortAlongHilbert(std::vector<glm::ivec3>& cells, glm::ivec3 dimensions);

/// Parts that a frame is divided into for distributed rendering. Fixed, so that sums over shares do not depend on the number of
/// processes among which the shares are dealt.
inline constexpr int kShares = 256;

/// The share of a chunk from its position in the list of the stored chunks of its octree level in Hilbert order: round robin, so that
/// every share has nearly equally many chunks of each level (Section 4.4). Shares take turns in the order of their reversed bits, so that
/// those that follow each other, which a process draws, are spread through the volume.
inline constexpr int shareOf(std::uint64_t position) {
  int share = 0;
  for (int bit = 1; bit < kShares; bit *= 2, position /= 2) share = 2 * share + int(position % 2);
  return share;
}
static_assert((kShares & (kShares - 1)) == 0);

}  // namespace freevoxels
