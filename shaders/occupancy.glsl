// Which blocks are occupied, and their ranks.
#ifndef OCCUPANCY_GLSL
#define OCCUPANCY_GLSL
#include "blocks.glsl"
#include "rank.glsl"
#ifndef OCCUPANCY_BINDING
#error "Define OCCUPANCY_BINDING, the binding of the occupancy words, before including occupancy.glsl."
#endif

layout(scalar, binding = OCCUPANCY_BINDING) readonly buffer Occupancy { OccupancyWord occupancy[]; };

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

#endif
