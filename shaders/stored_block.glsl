// The extinction of blocks, of which only the occupied are stored. Include after blocks.glsl. `occupancy` is
// the buffer of words, STORES the BlockStores.
#include "stores.glsl"
#include "rank.glsl"
#include "occupancy.glsl"

// 0 for a block that is not occupied, and outside.
float extinctionOf(BlockLevel level, ivec3 cell) {
  if (!isInside(level, cell)) return 0.0;
  const uint address = blockAddress(level, cell);
  return isOccupied(address) ? storedExtinction(rankAt(level, address)) : 0.0;
}
