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
  ivec3 extent;   // voxels along each axis that are inside the volume
  vec3 center;    // centre of that part, index space
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

// The largest component of a block's emission, or 0 for a block that is not occupied.
float brightnessOf(BlockLevel level, ivec3 cell) {
  const uint address = blockAddress(level, cell);
  if (!kEmits || !isOccupied(address)) return 0.0;
  const vec3 light = unpackLight(storedEmission(rankAt(level, address)));
  return max(light.r, max(light.g, light.b));
}

// The centre of a block's extinction, from its children: a block that is half empty is drawn where its other
// half is. With emission, the point half-way to the centre of the emission.
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
  // Emission that is too faint for every child may leave nothing to weight by.
  if (kEmits && mass == 0.0) return block.center;
  return block.center + sum / mass;
}

#endif
