// The extinction of blocks. Parameters: OCCUPANCY_BINDING (occupancy.glsl) and STORES (stores.glsl).
#ifndef STORED_BLOCK_GLSL
#define STORED_BLOCK_GLSL
#include "occupancy.glsl"
#include "stores.glsl"

// 0 for a block that is not occupied, and outside.
float extinctionOf(BlockLevel level, ivec3 cell) {
  if (!isInside(level, cell)) return 0.0;
  const uint address = blockAddress(level, cell);
  return isOccupied(address) ? storedExtinction(rankAt(level, address)) : 0.0;
}

#endif
