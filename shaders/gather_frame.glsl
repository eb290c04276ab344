// The frame of the gather's passes, in binding 0.
#ifndef GATHER_FRAME_GLSL
#define GATHER_FRAME_GLSL
#include "gather_interface.h"

layout(scalar, binding = 0) uniform Frame { GatherFrame frame; };

#endif
