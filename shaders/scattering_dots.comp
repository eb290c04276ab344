#version 460
// Scalar products of a vector with others: a sum for each workgroup, always in the same order.
#extension GL_GOOGLE_include_directive : require
#include "scattering_interface.h"

layout(local_size_x = kDotThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringDotsPush push; };
layout(binding = 0, scalar) readonly restrict buffer Vectors { float vectors[]; };
layout(binding = 1, scalar) writeonly restrict buffer Sums { float sums[]; };  // by product and workgroup

shared float parts[kDotThreads];

void main() {
  const int thread = int(gl_LocalInvocationIndex), group = int(gl_WorkGroupID.x);
  for (int product = 0; product < push.count; ++product) {
    float sum = 0.0;
    for (int i = group * kDotThreads + thread; i < push.values; i += kDotThreads * kDotGroups)
      sum += vectors[push.vector * push.values + i] * vectors[(push.first + product) * push.values + i];
    parts[thread] = sum;
    barrier();
    for (int others = kDotThreads / 2; others > 0; others /= 2) {
      if (thread < others) parts[thread] += parts[thread + others];
      barrier();
    }
    if (thread == 0) sums[product * kDotGroups + group] = parts[0];
    barrier();
  }
}
