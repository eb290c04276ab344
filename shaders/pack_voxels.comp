#version 460
// Writes extinction, colours and emission of the occupied voxels at their ranks, brick by brick.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "brick_row.glsl"

layout(constant_id = 1) const bool kColors = false;  // whether voxels have their own colours

#define OCCUPANCY_BINDING 3
#include "occupancy.glsl"
#define STORES push.stores
#include "stores.glsl"
layout(scalar, binding = 4) readonly buffer BrickColors { uint brickColors[]; };  // as the densities

void main() {
  const uint brick = brickOfThread();
  if (brick >= push.brickCount) return;
  const Row row = loadRow(brick);
  if (row.holding == 0) return;
  // Voxels of a row are consecutive, and so are the ranks of its occupied voxels.
  uint rank = rankAt(push.voxels, blockAddress(push.voxels, row.first + ivec3(findLSB(row.holding), 0, 0)));
  [[unroll]] for (int i = 0; i < kBrickEdge; ++i) {
    if ((row.holding >> i & 1u) == 0) continue;
    FloatStore(push.stores.extinction).values[rank] = row.extinction[i];
    if (kColors) WordStore(push.stores.colors).values[rank] = brickColors[(brick * kBrickThreads + gl_LocalInvocationIndex) * kBrickEdge + i];
    if (kEmits) WordStore(push.stores.emission).values[rank] = row.emission[i];
    ++rank;
  }
}
