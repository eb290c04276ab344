// What both passes of the cut read: the frame in binding 0, the list of the level above in binding 1, and the push constants.
#ifndef CUT_FRAME_GLSL
#define CUT_FRAME_GLSL
#include "blocks.glsl"

layout(scalar, push_constant) uniform Push { CutPush push; };
layout(scalar, binding = 0) uniform Frame { CutFrame frame; };
layout(scalar, binding = 1) readonly buffer Parents { uint parents[]; };

// The slots of a level of the cut are eight for each occupied block of the level above, for its children; the coarsest level has one.
ivec3 cellOfSlot(uint slot) {
  if (push.level == frame.top) return ivec3(0);
  const ivec3 corner = ivec3(slot & 1, slot >> 1 & 1, slot >> 2 & 1);
  return 2 * cellAt(frame.levels[push.level + 1], parents[slot / 8]) + corner;
}

#endif
