#version 460
// Where rays may skip slices: of each block of a level above the voxels whether it or one of its next neighbours along
// the axes upwards is occupied. A position that is in the block stays in these for an edge more.
#extension GL_GOOGLE_include_directive : require
#include "gather_interface.h"
#include "blocks.glsl"
#include "rank.glsl"

layout(local_size_x = kOccupancyThreads) in;
layout(scalar, push_constant) uniform Push { SkipCellsPush push; };
layout(scalar, binding = 0) readonly buffer Occupancy { OccupancyWord occupancy[]; };
layout(scalar, binding = 1) writeonly buffer SkipCells { uint skipCells[]; };
#include "occupancy.glsl"

void main() {
  const uint block = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kOccupancyThreads;
  if (block >= push.count) return;
  const uint address = push.level.first + block;
  const ivec3 cell = cellAt(push.level, address);
  bool occupied = false;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 neighbour = cell + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (isInside(push.level, neighbour) && holdsAnything(blockAddress(push.level, neighbour))) occupied = true;
  }
  skipCells[address - push.firstCell] = occupied ? 1u : 0u;
}
