// The octree's blocks: engine/octree/hierarchy_layout.h. Include after interface.h.

// Where a block is, here and in HierarchyLayout::indexOf and nowhere else.
uint blockAddress(BlockLevel level, ivec3 cell) {
  return level.first + uint(cell.x + level.rowPitch * (cell.y + level.dimensions.y * cell.z));
}

ivec3 cellAt(BlockLevel level, uint address) {
  const uint index = address - level.first;
  const uint row = index / level.rowPitch;
  const uint plane = row / level.dimensions.y;
  return ivec3(index - row * level.rowPitch, row - plane * level.dimensions.y, plane);
}

// The byte of a direction of the table in which the bound is of a block above the voxels that has this rank, and which of
// those in it.
uint boundOf(BlockLevel level, uint rank) { return level.firstBound + (rank - level.firstRank) / kBoundBlocks; }
int boundInByte(BlockLevel level, uint rank) { return int((rank - level.firstRank) % kBoundBlocks); }

// How much of a block is inside of the volume, in voxels along each axis; not positive outside.
ivec3 extentInside(ivec3 cell, int edge, ivec3 voxels) { return min(voxels - cell * edge, ivec3(edge)); }

// The colour of a block above the voxels, in 8 bytes.
uvec2 packColor(vec3 color) { return uvec2(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, 0.0))); }
vec3 unpackColor(uvec2 bits) { return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x); }
