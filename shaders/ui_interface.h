#ifndef FREEVOXELS_UI_INTERFACE_H
#define FREEVOXELS_UI_INTERFACE_H
// Constants and structs of the user interface that C++ and GLSL share, as those of interface.h.
#include "interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

// A corner of a triangle, as Dear ImGui has it.
struct UiVertex {
  vec2 position;  // pixels from the window's upper left corner
  vec2 texel;     // 0..1 over the texture
  uint color;     // sRGB, straight alpha; red in the lowest byte
};

struct UiPush {
  vec2 scale, offset;  // of positions to Vulkan's clip space
};

#ifdef __cplusplus
}
#endif
#endif
