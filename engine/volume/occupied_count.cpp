#include "engine/volume/occupied_count.h"

#include <algorithm>
#include <utility>

namespace freevoxels {

std::vector<std::uint64_t> countOccupiedBlocks(glm::ivec3 dimensions, std::vector<bool> occupied) {
  const auto index = [](glm::ivec3 cell, glm::ivec3 size) {
    return std::size_t(cell.x) + std::size_t(size.x) * (std::size_t(cell.y) + std::size_t(size.y) * std::size_t(cell.z));
  };
  std::vector<std::uint64_t> counts;
  for (glm::ivec3 n = dimensions;; n = (n + 1) / 2) {
    counts.push_back(std::uint64_t(std::ranges::count(occupied, true)));
    if (n == glm::ivec3(1)) return counts;
    const glm::ivec3 parents = (n + 1) / 2;
    std::vector<bool> above(std::size_t(parents.x) * std::size_t(parents.y) * std::size_t(parents.z), false);
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x)
          if (occupied[index({x, y, z}, n)]) above[index(glm::ivec3(x, y, z) / 2, parents)] = true;
    occupied = std::move(above);
  }
}

}  // namespace freevoxels
