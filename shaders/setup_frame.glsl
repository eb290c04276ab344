// What splat_setup.comp and shade_blocks.comp read: the frame, the addresses of the table's planes, the occupancy and the lights, in
// bindings 0 to 3, and how they are specialised.
#ifndef SETUP_FRAME_GLSL
#define SETUP_FRAME_GLSL
#include "frame_interface.h"

const bool kLit = LIT;  // a definition of the compiler; else a voxel sends out its colour
layout(constant_id = 0) const bool kEmits = false;    // whether voxels have emission
layout(constant_id = 1) const bool kColors = false;   // whether voxels have colours of their own
layout(constant_id = 2) const bool kTinted = false;   // whether every colour of light has an extinction of its own
layout(constant_id = 3) const bool kAnyView = false;  // whether light is computed for all positions of the eye (lighting.glsl)

layout(scalar, binding = 0) readonly buffer Frame { SetupFrame frame; };
#define PLANE_ADDRESSES_BINDING 1
#define OCCUPANCY_BINDING 2
layout(scalar, binding = 3) readonly buffer Lights { Light lights[]; };
#define STORES frame.stores

#endif
