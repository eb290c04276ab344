#version 460
// First pass of the visible-voxel list: how many voxels of each workgroup's stretch have extinction.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kCountThreads) in;
layout(scalar, push_constant) uniform Push { VisiblePush push; };
layout(binding = 0) uniform textureBuffer extinction;
layout(scalar, binding = 1) buffer GroupCounts { uint groupCounts[]; };

shared uint total;

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint first = group * kCountVoxelsPerGroup + gl_LocalInvocationIndex * kCountVoxelsPerThread;
  if (gl_LocalInvocationIndex == 0) total = 0;
  barrier();
  if (first < push.voxelCount) {
    uint count = 0;
    [[unroll]] for (uint q = 0; q < kCountVoxelsPerThread / 4; ++q) {
      const bvec4 visible = greaterThan(texelFetch(extinction, int((push.first + first) / 4 + q)), vec4(0.0));
      count += uint(visible.x) + uint(visible.y) + uint(visible.z) + uint(visible.w);
    }
    atomicAdd(total, count);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0 && group < push.groupCount) groupCounts[group] = total;
}
