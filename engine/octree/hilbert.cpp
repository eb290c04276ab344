#include "engine/octree/hilbert.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// Distributes the bits of the index to three numbers: bit 3 b + 2 - i of the index is bit b of number i
/// (Skilling's "transposed" form).
using Transposed = std::array<std::uint32_t, 3>;

Transposed transposed(std::uint64_t index, int bits) {
  Transposed result{};
  for (int b = 0; b < bits; ++b)
    for (int i = 0; i < 3; ++i) result[std::size_t(i)] |= std::uint32_t(index >> (3 * b + 2 - i) & 1u) << b;
  return result;
}

std::uint64_t joined(const Transposed& parts, int bits) {
  std::uint64_t index = 0;
  for (int b = 0; b < bits; ++b)
    for (int i = 0; i < 3; ++i) index |= std::uint64_t(parts[std::size_t(i)] >> b & 1u) << (3 * b + 2 - i);
  return index;
}

/// Reflects or exchanges the axes within the subcubes of edge `bit`, depending on that bit of coordinate i. Its own inverse.
void turn(Transposed& x, std::size_t i, std::uint32_t bit) {
  const std::uint32_t below = bit - 1;
  if (x[i] & bit) {
    x[0] ^= below;
  } else {
    const std::uint32_t different = (x[0] ^ x[i]) & below;
    x[0] ^= different;
    x[i] ^= different;
  }
}

}  // namespace

std::uint64_t hilbertIndex(glm::uvec3 cell, int bits) {
  FV_CHECK_LE(bits, kMaxHilbertBits);
  Transposed x{cell.x, cell.y, cell.z};
  const std::uint32_t top = 1u << (bits - 1);
  for (std::uint32_t bit = top; bit > 1; bit >>= 1)
    for (std::size_t i = 0; i < 3; ++i) turn(x, i, bit);
  // Gray code.
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flipped = 0;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1)
    if (x[2] & bit) flipped ^= bit - 1;
  for (std::uint32_t& part : x) part ^= flipped;
  return joined(x, bits);
}

glm::uvec3 hilbertCell(std::uint64_t index, int bits) {
  FV_CHECK_LE(bits, kMaxHilbertBits);
  Transposed x = transposed(index, bits);
  const std::uint32_t last = x[2] >> 1;
  x[2] ^= x[1];
  x[1] ^= x[0];
  x[0] ^= last;
  for (std::uint32_t bit = 2; bit < 1u << bits; bit <<= 1)
    for (std::size_t i = 3; i-- > 0;) turn(x, i, bit);
  return {x[0], x[1], x[2]};
}

int hilbertBits(glm::ivec3 dimensions) {
  const int longest = std::max({dimensions.x, dimensions.y, dimensions.z});
  return std::max(int(std::bit_width(std::uint32_t(longest - 1))), 1);
}

void sortAlongHilbert(std::vector<glm::ivec3>& cells, glm::ivec3 dimensions) {
  const int bits = hilbertBits(dimensions);
  std::vector<std::pair<std::uint64_t, glm::ivec3>> places;
  places.reserve(cells.size());
  for (const glm::ivec3 cell : cells) places.emplace_back(hilbertIndex(glm::uvec3(cell), bits), cell);
  std::ranges::sort(places, {}, &std::pair<std::uint64_t, glm::ivec3>::first);
  std::ranges::transform(places, cells.begin(), &std::pair<std::uint64_t, glm::ivec3>::second);
}

std::vector<glm::ivec3> hilbertOrder(glm::ivec3 dimensions) {
  std::vector<glm::ivec3> cells;
  cells.reserve(std::size_t(dimensions.x) * std::size_t(dimensions.y) * std::size_t(dimensions.z));
  for (glm::ivec3 cell(0); cell.z < dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < dimensions.x; ++cell.x) cells.push_back(cell);
  sortAlongHilbert(cells, dimensions);
  return cells;
}

}  // namespace freevoxels
