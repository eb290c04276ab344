// Which blocks are occupied, and their ranks. Include after blocks.glsl and rank.glsl. `occupancy` is the
// buffer of words.

bool isInside(BlockLevel level, ivec3 cell) {
  return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, level.dimensions));
}

bool isOccupied(uint address) {
  return (occupancy[address / kBlocksPerWord].mask >> (address % kBlocksPerWord) & 1u) != 0;
}

// The rank of an occupied block.
uint rankAt(BlockLevel level, uint address) {
  const OccupancyWord word = occupancy[address / kBlocksPerWord];
  return level.firstRank + rankIn(uvec2(word.mask, word.before), int(address % kBlocksPerWord));
}
