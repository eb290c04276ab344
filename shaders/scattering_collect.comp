#version 460
// Adds the light of a batch of directions to the moments of each cell, and combines the sums of all batches with another vector.
#extension GL_GOOGLE_include_directive : require
#include "scattering_interface.h"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 1) const bool kFlux = false;

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringCollectPush push; };
layout(binding = 0, scalar) readonly restrict buffer Directions { SweepDirection directions[]; };
layout(binding = 1, scalar) readonly restrict buffer Light { float light[]; };
layout(binding = 2, scalar) restrict buffer Vectors { float vectors[]; };

void main() {
  const int cell = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  if (cell >= push.count) return;
  const int moments = kFlux ? 4 : 1, vectorLength = moments * kChannels * push.count;
  [[unroll]] for (int c = 0; c < kChannels; ++c) {
    const int place = push.to * vectorLength + c * push.count + cell, toNext = kChannels * push.count;
    vec4 sum = vec4(0.0);
    if (push.isFirst == 0) [[unroll]] for (int m = 0; m < moments; ++m) sum[m] = vectors[place + m * toNext];
    for (int d = 0; d < push.directionCount; ++d) {
      const float own = light[(d * kChannels + c) * push.count + cell];
      sum.x += own;
      if (kFlux) sum.yzw += own * directions[push.firstDirection + d].unit;
    }
    [[unroll]] for (int m = 0; m < moments; ++m) {
      float value = sum[m];
      if (push.isLast != 0) {
        value *= push.ofSum;
        if (push.ofFrom != 0.0) value += push.ofFrom * vectors[push.from * vectorLength + c * push.count + cell + m * toNext];
      }
      vectors[place + m * toNext] = value;
    }
  }
}
