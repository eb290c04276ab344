// What both passes of the cut read: the frame in binding 0, the list of the level above in binding 1, and the push constants.
#ifndef CUT_FRAME_GLSL
#define CUT_FRAME_GLSL
#include "interface.h"

layout(scalar, push_constant) uniform Push { CutPush push; };
layout(scalar, binding = 0) uniform Frame { CutFrame frame; };
layout(scalar, binding = 1) readonly buffer Parents { uint parents[]; };

#endif
