// The candidates of a level of the cut: eight slots for the children of each occupied block of the level
// above; one slot for the coarsest level. Include after blocks.glsl. `frame` is the CutFrame, `parents` the
// list of the level above.

ivec3 cellOfSlot(uint slot) {
  if (push.level == frame.top) return ivec3(0);
  const ivec3 corner = ivec3(slot & 1, slot >> 1 & 1, slot >> 2 & 1);
  return 2 * cellAt(frame.levels[push.level + 1], parents[slot / 8]) + corner;
}
