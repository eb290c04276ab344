// A drawn block. Include after blocks.glsl; `frame` is the SetupFrame.

struct Block {
  int level;
  int edge;       // voxels
  ivec3 cell;
  ivec3 extent;   // voxels inside of the volume
  vec3 center;    // of that part, index space
};

Block blockOf(int level, ivec3 cell) {
  Block block;
  block.level = level;
  block.edge = 1 << level;
  block.cell = cell;
  block.extent = extentInside(cell, block.edge, frame.dimensions);
  block.center = vec3(cell * block.edge) + 0.5 * vec3(block.extent - 1);
  return block;
}

Block blockAt(uint address) {
  int level = 0;
  while (level + 1 < frame.levelCount && address >= frame.levels[level + 1].first) ++level;
  return blockOf(level, cellAt(frame.levels[level], address));
}
