#version 460
// Scalar products of a vector with others: each thread writes its part of every sum, and the host adds the parts in a fixed order. Sums of
// workgroups would need barriers, which cost lavapipe more than the products.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringDotsPush push; };
layout(binding = 0) uniform textureBuffer vectors;
layout(binding = 1, scalar) writeonly restrict buffer Sums { float sums[]; };  // by product and thread

void main() {
  const int thread = int(gl_GlobalInvocationID.x);
  for (int product = 0; product < push.count; ++product) {
    float sum = 0.0;
    for (int i = thread; i < push.values; i += kDotSums)
      sum += texelFetch(vectors, push.vector * push.values + i).x * texelFetch(vectors, (push.first + product) * push.values + i).x;
    sums[product * kDotSums + thread] = sum;
  }
}
