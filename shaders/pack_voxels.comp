#version 460
// The extinction, the colours and the light of the voxels that hold anything, each at its rank, brick by brick.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "blocks.glsl"
#include "rank.glsl"
#include "brick_row.glsl"

layout(constant_id = 1) const bool kColors = false;  // voxels have colours of their own

layout(scalar, binding = 3) readonly buffer Occupancy { OccupancyWord occupancy[]; };
#include "occupancy.glsl"
layout(scalar, binding = 4) writeonly buffer Extinction { float extinction[]; };
layout(scalar, binding = 5) writeonly buffer Colors { uint colors[]; };
layout(scalar, binding = 6) writeonly buffer Emission { uint emission[]; };
layout(scalar, binding = 7) readonly buffer BrickColors { uint brickColors[]; };  // as the densities

void main() {
  const uint brick = brickOfThread();
  if (brick >= push.brickCount) return;
  const Row row = loadRow(brick);
  if (row.holding == 0) return;
  // Voxels of a row follow one another: so do the ranks of those that hold anything.
  uint rank = rankAt(push.voxels, blockAddress(push.voxels, row.first + ivec3(findLSB(row.holding), 0, 0)));
  [[unroll]] for (int i = 0; i < kBrickEdge; ++i) {
    if ((row.holding >> i & 1u) == 0) continue;
    extinction[rank] = row.extinction[i];
    if (kColors) colors[rank] = brickColors[(brick * kBrickThreads + gl_LocalInvocationIndex) * kBrickEdge + i];
    if (kEmits) emission[rank] = row.emission[i];
    ++rank;
  }
}
