#version 460
// First of a digit's three passes: counts the values of the digit in each workgroup's stretch.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "radix_stretch.glsl"

layout(local_size_x = kSortThreads) in;
layout(scalar, push_constant) uniform Push { RadixPush push; };
layout(scalar, binding = 0) readonly buffer Count { uint count; };
layout(scalar, binding = 1) readonly buffer Keys { uint keys[]; };
layout(scalar, binding = 2) writeonly buffer Offsets { uint offsets[]; };  // [group][digit]

shared uint histogram[kSortDigits];

void main() {
  const uint thread = gl_LocalInvocationIndex;
  histogram[thread] = 0;
  barrier();
  const uint last = stretchLast(count);
  for (uint i = stretchFirst(count) + thread; i < last; i += kSortThreads)
    atomicAdd(histogram[(keys[i] >> push.shift) & (kSortDigits - 1)], 1);
  barrier();
  offsets[gl_WorkGroupID.x * kSortDigits + thread] = histogram[thread];
}
