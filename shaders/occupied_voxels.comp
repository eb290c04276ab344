#version 460
// Which voxels hold anything, brick by brick.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "blocks.glsl"
#include "brick_row.glsl"

layout(scalar, binding = 3) buffer Occupancy { OccupancyWord occupancy[]; };

void main() {
  const uint brick = brickOfThread();
  if (brick >= push.brickCount) return;
  const Row row = loadRow(brick);
  if (row.holding == 0) return;
  const int start = findLSB(row.holding);  // in the box, which the row may begin before
  const uint address = blockAddress(push.voxels, row.first + ivec3(start, 0, 0));
  const uint bits = row.holding >> start, place = address % kBlocksPerWord;
  // Rows of bricks share words with others.
  atomicOr(occupancy[address / kBlocksPerWord].mask, bits << place);
  if (place > kBlocksPerWord - kBrickEdge) {
    const uint rest = bits >> (kBlocksPerWord - place);
    if (rest != 0) atomicOr(occupancy[address / kBlocksPerWord + 1].mask, rest);
  }
}
