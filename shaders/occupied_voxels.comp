#version 460
// Marks the occupied voxels, brick by brick.
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
  const int start = findLSB(row.holding);  // first voxel of the row that is in the box, since the row may begin before the box
  const uint address = blockAddress(push.voxels, row.first + ivec3(start, 0, 0));
  const uint bits = row.holding >> start, place = address % kBlocksPerWord;
  // Rows of different bricks share words.
  atomicOr(occupancy[address / kBlocksPerWord].mask, bits << place);
  if (place > kBlocksPerWord - kBrickEdge) {
    const uint rest = bits >> (kBlocksPerWord - place);
    if (rest != 0) atomicOr(occupancy[address / kBlocksPerWord + 1].mask, rest);
  }
}
