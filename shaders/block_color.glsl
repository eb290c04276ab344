// The colour of a block.
#ifndef BLOCK_COLOR_GLSL
#define BLOCK_COLOR_GLSL
#include "block_at.glsl"

vec3 colorOf(Block block, uint rank) {
  if (!kColors) return frame.albedo;
  if (block.level > 0) return unpackColor(storedBlockColor(rank - frame.levels[1].firstRank));
  return unpackLight(storedColor(rank));
}

#endif
