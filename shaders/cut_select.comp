#version 460
// First pass of the cut through the octree, one dispatch a level: which of the level's blocks are drawn, a bit a
// block, and how many of each workgroup's. Subr et al. 2007, Section 3.3: the level is chosen by the size on the
// image. A block is drawn where it is small and its parent is not; a parent is twice as large as its children and
// as near to the eye as the nearest of them, so of the blocks around a voxel exactly one is drawn.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "blocks.glsl"

layout(local_size_x = kCutThreads) in;
layout(scalar, push_constant) uniform Push { CutPush push; };
layout(scalar, binding = 0) readonly buffer Blocks { uint blocks[]; };
layout(scalar, binding = 1) writeonly buffer Masks { uint masks[]; };
layout(scalar, binding = 2) buffer GroupCounts { uint groupCounts[]; };

shared uint total;

// `precise`: the block itself and its children ask this, and must get the same answer.
bool isSmall(ivec3 cell, int edge) {
  precise vec3 toCenter = (vec3(cell) + 0.5) * float(edge) - 0.5 - push.middle;
  precise float center = push.viewAxis.x * toCenter.x + push.viewAxis.y * toCenter.y + push.viewAxis.z * toCenter.z;
  precise float reach = 0.5 * float(edge) * (abs(push.viewAxis.x) + abs(push.viewAxis.y) + abs(push.viewAxis.z));
  precise float nearest = center + push.middleDistance - reach;
  return float(edge) <= push.edgePerDistance * nearest;
}

bool isDrawn(ivec3 cell, int level) {
  return (level == push.finest || isSmall(cell, push.edge)) && (level == push.coarsest || !isSmall(cell / 2, 2 * push.edge));
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint thread = group * kCutThreads + gl_LocalInvocationIndex;
  const uint first = thread * kCutBlocksPerThread;
  const int level = findMSB(push.edge);
  if (gl_LocalInvocationIndex == 0) total = 0;
  barrier();
  if (first < push.blockCount) {
    const uint count = min(push.blockCount - first, uint(kCutBlocksPerThread));
    uint mask = 0;
    for (uint i = 0; i < count; ++i)
      if (isDrawn(cellAt(push.level, blocks[first + i]), level)) mask |= 1u << i;
    masks[push.firstGroup * kCutThreads + thread] = mask;
    atomicAdd(total, bitCount(mask));
  }
  barrier();
  if (gl_LocalInvocationIndex == 0 && first < push.blockCount) groupCounts[push.firstGroup + group] = total;
}
