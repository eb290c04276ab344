// Reads a row of a brick, a thread for each row: densities (extinction is density x scale) and emission
// (packed_light.glsl). Uses the bindings 0 to 2 and the push
// constants.
#ifndef BRICK_ROW_GLSL
#define BRICK_ROW_GLSL
#include "interface.h"

layout(constant_id = 0) const bool kEmits = false;

layout(local_size_x = kBrickThreads) in;
layout(scalar, push_constant) uniform Push { BricksPush push; };
layout(scalar, binding = 0) readonly buffer Densities { vec4 densities[]; };
layout(scalar, binding = 1) readonly buffer FirstVoxels { ivec3 firstVoxels[]; };  // of each brick
layout(scalar, binding = 2) readonly buffer Emissions { uint emissions[]; };       // as the densities

struct Row {
  float extinction[kBrickEdge];
  uint emission[kBrickEdge];
  uint holding;  // a bit for each voxel with extinction or emission; 0 beyond the box
  ivec3 first;   // voxel
};

uint brickOfThread() { return gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x; }

Row loadRow(uint brick) {
  const int thread = int(gl_LocalInvocationIndex);
  Row row;
  row.first = firstVoxels[brick] + ivec3(0, thread % kBrickEdge, thread / kBrickEdge);
  row.holding = 0;
  [[unroll]] for (int q = 0; q < kBrickEdge / 4; ++q) {
    const vec4 quad = densities[(brick * kBrickThreads + thread) * (kBrickEdge / 4) + q];
    [[unroll]] for (int c = 0; c < 4; ++c) {
      const int i = 4 * q + c;
      // Voxels without data have a negative density.
      row.extinction[i] = min(max(quad[c], 0.0) * push.densityScale, kMaxExtinction);
      row.emission[i] = kEmits ? emissions[(brick * kBrickThreads + thread) * kBrickEdge + i] : 0;
      row.holding |= uint(row.extinction[i] > 0.0 || row.emission[i] != 0) << i;
    }
  }
  return row;
}

#endif
