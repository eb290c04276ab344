#version 460
// Interpolates the solution on coarse cells to cells of half the edge, trilinearly between the centres of the coarse ones.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringRefinePush push; };
layout(binding = 0) uniform textureBuffer coarse;
layout(binding = 1, scalar) writeonly restrict buffer Fine { float fine[]; };

void main() {
  const int number = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const ivec3 n = push.cells, m = push.coarseCells;
  const int count = n.x * n.y * n.z, coarseCount = m.x * m.y * m.z;
  if (number >= count) return;
  const ivec3 cell = ivec3(number % n.x, number / n.x % n.y, number / (n.x * n.y));
  const ivec3 own = cell / 2, next = clamp(own + 2 * (cell & 1) - 1, ivec3(0), m - 1);
  for (int plane = 0; plane < push.planes; ++plane) {
    float sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const bvec3 far = bvec3(corner & 1, corner & 2, corner & 4);
      const ivec3 at = mix(own, next, far);
      const vec3 shares = mix(vec3(0.75), vec3(0.25), far);
      sum += shares.x * shares.y * shares.z * texelFetch(coarse, plane * coarseCount + at.x + m.x * (at.y + m.y * at.z)).x;
    }
    fine[plane * count + number] = sum;
  }
}
