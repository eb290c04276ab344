#version 460
// A combination of vectors.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringCombinePush push; };
layout(binding = 0) uniform textureBuffer before;  // the vectors, which the next binding writes: a thread reads what no other one writes
layout(binding = 1, scalar) writeonly buffer Vectors { float vectors[]; };

void main() {
  const int i = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  if (i >= push.values) return;
  float sum = push.from < 0 ? 0.0 : texelFetch(before, push.from * push.values + i).x;
  for (int v = 0; v < push.count; ++v) sum += push.factors[v] * texelFetch(before, (push.first + v) * push.values + i).x;
  vectors[push.to * push.values + i] = push.scale * sum;
}
