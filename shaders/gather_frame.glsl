// The frame of the gather's passes, in binding 0.
#ifndef GATHER_FRAME_GLSL
#define GATHER_FRAME_GLSL
#include "gather_interface.h"

layout(scalar, binding = 0) uniform Frame { GatherFrame frame; };

// The place in the lattice's sums of a sample, or of the nearest one that is stored.
int placeOfSample(ivec2 index) {
  const ivec2 stored = clamp(index, frame.firstSeen, frame.firstSeen + frame.seenExtent - 1);
  return stored.x + stored.y * frame.samples.x;
}

#endif
