#version 460
// Adds the light of a batch of directions to the moments of each cell, and combines the sums of all batches with another vector. Sums go
// on from batch to batch in the order of directions, so that they do not depend on how many directions a batch has.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 1) const bool kFlux = false;

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringCollectPush push; };
layout(binding = 0, scalar) readonly restrict buffer Directions { SweepDirection directions[]; };
layout(binding = 1) uniform textureBuffer light;  // by direction of the batch, channel and cell
layout(binding = 2) uniform textureBuffer before;  // the vectors, which the next binding writes: a thread reads what no other one writes
layout(binding = 3, scalar) writeonly buffer Vectors { float vectors[]; };

void main() {
  const int cell = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  if (cell >= push.count) return;
  const int moments = kFlux ? 4 : 1, vectorLength = moments * kChannels * push.count;
  const int toNext = kChannels * push.count;
  vec3 sums[4] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));  // by moment
  if (push.firstDirection > 0)
    [[unroll]] for (int m = 0; m < moments; ++m)
      [[unroll]] for (int c = 0; c < kChannels; ++c) sums[m][c] = texelFetch(before, push.to * vectorLength + m * toNext + c * push.count + cell).x;
  for (int d = 0; d < push.directions; ++d) {
    vec3 own = vec3(0.0);
    [[unroll]] for (int c = 0; c < kChannels; ++c) own[c] = texelFetch(light, (d * kChannels + c) * push.count + cell).x;
    sums[0] += own;
    if (kFlux) [[unroll]] for (int i = 0; i < 3; ++i) sums[1 + i] += own * directions[push.firstDirection + d].unit[i];
  }
  [[unroll]] for (int m = 0; m < moments; ++m)
    [[unroll]] for (int c = 0; c < kChannels; ++c) {
      const int place = m * toNext + c * push.count + cell;
      const bool hasFrom = push.isLast != 0 && push.ofFrom != 0.0;
      const float from = hasFrom ? push.ofFrom * texelFetch(before, push.from * vectorLength + place).x : 0.0;
      vectors[push.to * vectorLength + place] = (push.isLast != 0 ? push.ofSum : 1.0) * sums[m][c] + from;
    }
}
