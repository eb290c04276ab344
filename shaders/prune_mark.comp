#version 460
// Marks the runs of blocks from which light leaves in any of the table's directions, a bit each; a thread for
// each run.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "interface.h"

layout(local_size_x = kRunThreads) in;
layout(scalar, push_constant) uniform Push { RunsPush push; };
layout(scalar, binding = 0) readonly buffer PlaneAddresses { uvec2 planeAddresses[]; };
layout(scalar, binding = 1) writeonly buffer SeenRuns { OccupancyWord words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodePlane { uvec2 runs[]; };

const uint kWords = kRunThreads / kBlocksPerWord;
shared uint masks[kWords];

bool isSeen(uint run) {
  for (uint cell = 0; cell < push.cellCount; ++cell) {
    const uvec2 plane = planeAddresses[cell];
    if (plane != uvec2(0) && CodePlane(plane).runs[run] != uvec2(push.maxCodePerDirection)) return true;
  }
  return false;
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const uint thread = gl_LocalInvocationIndex;
  const uint run = group * kRunThreads + thread;
  if (thread < kWords) masks[thread] = 0;
  barrier();
  if (run < push.runCount && isSeen(run)) atomicOr(masks[thread / kBlocksPerWord], 1u << (thread % kBlocksPerWord));
  barrier();
  if (thread < kWords && run < push.runCount) words[group * kWords + thread] = OccupancyWord(masks[thread], 0);
}
