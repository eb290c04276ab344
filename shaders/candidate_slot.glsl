// The slots of a level of the cut: eight for each occupied block of the level above, for its children; the coarsest level has one.
#ifndef CANDIDATE_SLOT_GLSL
#define CANDIDATE_SLOT_GLSL
#include "blocks.glsl"
#include "cut_frame.glsl"

ivec3 cellOfSlot(uint slot) {
  if (push.level == frame.top) return ivec3(0);
  const ivec3 corner = ivec3(slot & 1, slot >> 1 & 1, slot >> 2 & 1);
  return 2 * cellAt(frame.levels[push.level + 1], parents[slot / 8]) + corner;
}

#endif
