#version 460
// Moves the codes of a direction's kept runs together. The first run stands for all removed ones.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "rank.glsl"

layout(local_size_x = kRunThreads) in;
layout(scalar, push_constant) uniform Push { RunsPush push; };
layout(scalar, binding = 0) readonly buffer SeenRuns { OccupancyWord words[]; };
layout(scalar, binding = 1) readonly buffer From { uvec2 from[]; };
layout(scalar, binding = 2) writeonly buffer To { uvec2 to[]; };

void main() {
  const uint run = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kRunThreads;
  if (run >= push.runCount) return;
  if (run == 0) to[0] = uvec2(push.maxCodePerDirection);
  const OccupancyWord word = words[run / kBlocksPerWord];
  const int bit = int(run % kBlocksPerWord);
  if ((word.mask >> bit & 1u) != 0) to[rankIn(uvec2(word.mask, word.before), bit)] = from[run];
}
