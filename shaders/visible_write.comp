#version 460
// Third pass of the visible-voxel list: every voxel with extinction writes its index at its place, in
// ascending order, so that the splats, and the rounding of their sums, come in the same order every time.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kCountThreads) in;
layout(scalar, push_constant) uniform Push { VisiblePush push; };
layout(binding = 0) uniform textureBuffer extinction;
layout(scalar, binding = 1) readonly buffer GroupOffsets { uint groupOffsets[]; };
layout(scalar, binding = 2) writeonly buffer VisibleVoxels { uint visibleVoxels[]; };

shared uint counts[kCountThreads];

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint thread = gl_LocalInvocationIndex;
  const uint first = group * kCountVoxelsPerGroup + thread * kCountVoxelsPerThread;
  uint mask = 0;  // bit i: voxel first + i is visible
  if (first < push.voxelCount) {
    [[unroll]] for (uint q = 0; q < kCountVoxelsPerThread / 4; ++q) {
      const bvec4 visible = greaterThan(texelFetch(extinction, int((push.first + first) / 4 + q)), vec4(0.0));
      [[unroll]] for (uint c = 0; c < 4; ++c) mask |= uint(visible[c]) << (4 * q + c);
    }
  }
  counts[thread] = bitCount(mask);
  barrier();

  if (mask == 0) return;
  uint offset = groupOffsets[group];
  for (uint i = 0; i < thread; ++i) offset += counts[i];
  for (; mask != 0; mask &= mask - 1) visibleVoxels[offset++] = push.first + first + uint(findLSB(mask));
}
