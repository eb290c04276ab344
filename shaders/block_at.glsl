// A block that is drawn, and its centre of mass.
#ifndef BLOCK_AT_GLSL
#define BLOCK_AT_GLSL
#include "packed_light.glsl"
#include "setup_frame.glsl"
#include "stored_block.glsl"

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

// The largest component; 0 of a block that holds nothing.
float brightnessOf(BlockLevel level, ivec3 cell) {
  const uint address = blockAddress(level, cell);
  if (!kEmits || !isOccupied(address)) return 0.0;
  const vec3 light = unpackLight(storedEmission(rankAt(level, address)));
  return max(light.r, max(light.g, light.b));
}

// Where a block's extinction is, as its children have it: one that is half empty is drawn where the other half is. With
// light half-way to where that is.
vec3 centerOfMass(Block block) {
  if (block.level == 0) return block.center;
  const BlockLevel children = frame.levels[block.level - 1];
  const float sigma = extinctionOf(frame.levels[block.level], block.cell);
  const float light = brightnessOf(frame.levels[block.level], block.cell);
  vec3 sum = vec3(0.0);
  float mass = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 cell = 2 * block.cell + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (any(greaterThanEqual(cell, children.dimensions))) continue;
    const Block child = blockOf(block.level - 1, cell);
    const vec3 part = vec3(child.extent) / vec3(block.extent);
    const float voxels = part.x * part.y * part.z;
    float share = kEmits && sigma == 0.0 ? 0.0 : extinctionOf(children, cell) / sigma * voxels;
    if (light > 0.0) share += brightnessOf(children, cell) / light * voxels;
    sum += share * (child.center - block.center);
    mass += share;
  }
  // Of light that is too faint for any block, nothing may be left.
  if (kEmits && mass == 0.0) return block.center;
  return block.center + sum / mass;
}

#endif
