// The blocks of the octree: engine/octree/hierarchy_layout.h.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#include "interface.h"

// The index of a block. Only this function and HierarchyLayout::indexOf compute it.
uint blockAddress(BlockLevel level, ivec3 cell) {
  return level.first + uint(cell.x + level.rowPitch * (cell.y + level.dimensions.y * cell.z));
}

ivec3 cellAt(BlockLevel level, uint address) {
  const uint index = address - level.first;
  const uint row = index / level.rowPitch;
  const uint plane = row / level.dimensions.y;
  return ivec3(index - row * level.rowPitch, row - plane * level.dimensions.y, plane);
}

// The byte of a table plane that has the bound of the block (above the voxels) with this rank, and the
// position of the bound in that byte.
uint boundOf(BlockLevel level, uint rank) { return level.firstBound + (rank - level.firstRank) / kBoundBlocks; }
int boundInByte(BlockLevel level, uint rank) { return int((rank - level.firstRank) % kBoundBlocks); }

// The part of a block inside the volume, in voxels along each axis; not positive if it is outside.
ivec3 extentInside(ivec3 cell, int edge, ivec3 voxels) { return min(voxels - cell * edge, ivec3(edge)); }

// The colour of a block above the voxels, in 8 bytes.
uvec2 packColor(vec3 color) { return uvec2(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, 0.0))); }
vec3 unpackColor(uvec2 bits) { return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x); }

#endif
