#version 460
// The sort key of every occupied voxel: ascending keys are back to front. It is the distance from the eye
// (orthographic: along the viewing axis) minus that of the volume's middle, so that a distant eye costs no
// precision: |m + o| - |m| = (2m + o) . o / (|m + o| + |m|), with m from the eye to the middle and o from
// there to the voxel.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"

layout(local_size_x = kSortThreads) in;
layout(scalar, push_constant) uniform Push { DepthKeyPush push; };
layout(scalar, binding = 0) readonly buffer BlockList { uint visibleVoxels[]; };
layout(scalar, binding = 1) readonly buffer Chunks { ChunkArguments chunks[]; };
layout(scalar, binding = 2) writeonly buffer Count { uint count; };
layout(scalar, binding = 3) writeonly buffer Keys { uint keys[]; };
layout(scalar, binding = 4) writeonly buffer Values { uint values[]; };

// Maps floats to unsigned integers in the same order; -0 and 0 are equal.
uint ordered(float x) {
  const uint bits = x == 0.0 ? 0u : floatBitsToUint(x);
  return bits ^ ((bits & 0x80000000u) != 0u ? 0xffffffffu : 0x80000000u);
}

// `precise`, because mirrored voxels must have equal keys, whatever operations the compiler would contract.
float relativeDistance(vec3 index) {
  const vec3 steps = index - push.middle;
  precise vec3 offset =
      push.indexToWorld[0] * steps.x + push.indexToWorld[1] * steps.y + push.indexToWorld[2] * steps.z;
  precise vec3 other = push.orthographic != 0 ? push.eyeToMiddle : 2.0 * push.eyeToMiddle + offset;
  precise float product = other.x * offset.x + other.y * offset.y + other.z * offset.z;
  if (push.orthographic != 0) return product;
  precise vec3 toVoxel = push.eyeToMiddle + offset;
  precise float length2 = toVoxel.x * toVoxel.x + toVoxel.y * toVoxel.y + toVoxel.z * toVoxel.z;
  return product / max(sqrt(length2) + push.eyeDistance, 1e-30);
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint i = group * kSortThreads + gl_LocalInvocationIndex;
  if (i == 0) {
    uint total = 0;
    for (uint chunk = 0; chunk < push.chunkCount; ++chunk) total += chunks[chunk].splatCount;
    count = total;
  }
  const uint chunk = i / kSplatsPerChunk;
  if (chunk >= push.chunkCount || i - chunk * kSplatsPerChunk >= chunks[chunk].splatCount) return;
  const uint voxel = visibleVoxels[i];
  const uint row = voxel / push.rowPitch;
  const uint plane = row / push.rows;
  const vec3 index = vec3(voxel - row * push.rowPitch, row - plane * push.rows, plane);
  keys[i] = ~ordered(relativeDistance(index));
  values[i] = voxel;
}
