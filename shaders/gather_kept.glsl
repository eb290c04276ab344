// What the loops of a march read of the frame, copied before them: lavapipe loads a uniform for each lane by itself wherever it is read, in
// some 27 instructions, which took half of a lit march.
#ifndef GATHER_KEPT_GLSL
#define GATHER_KEPT_GLSL
#include "gather_frame.glsl"

GatherFrame kept;  // of which compilers keep what is read

void keepFrame() { kept = frame; }

#endif
