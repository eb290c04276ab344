// The extinction of blocks, which is kept of those that hold anything. Include after blocks.glsl; `occupancy` is the
// buffer of words, STORES the BlockStores.
#include "stores.glsl"
#include "rank.glsl"
#include "occupancy.glsl"

// 0 of a block that holds nothing, and outside.
float extinctionOf(BlockLevel level, ivec3 cell) {
  if (!isInside(level, cell)) return 0.0;
  const uint address = blockAddress(level, cell);
  return isOccupied(address) ? storedExtinction(rankAt(level, address)) : 0.0;
}
