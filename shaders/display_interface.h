#ifndef FREEVOXELS_DISPLAY_INTERFACE_H
#define FREEVOXELS_DISPLAY_INTERFACE_H
// Constants and structs of the display pass that C++ and GLSL share, as those of interface.h.
#include "interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

FV_CONSTANT int kDisplayTile = 8;

// The table from linear light to sRGB bytes (engine/image/srgb.h) has a bucket for the floats that share all but their
// lowest kSrgbDroppedBits bits, beginning with 2^-13; smaller ones are byte 0. Floats from 1 on are byte 255.
FV_CONSTANT uint kSrgbFirstBits = 0x39000000u;
FV_CONSTANT uint kSrgbEndBits = 0x3f800000u;
FV_CONSTANT int kSrgbDroppedBits = 16;

struct SrgbBucket {
  float next;  // values from here on have the next byte
  uint byte;
};

// As ToneMap of engine/image/image.h.
FV_CONSTANT int kToneMapNone = 0;
FV_CONSTANT int kToneMapFilmic = 1;
FV_CONSTANT int kToneMapAces = 2;

struct DisplayPush {
  ivec2 size;           // pixels
  float gain;           // 2^exposure
  int toneMap;
  int hasBackground;
  vec3 top, bottom;     // the background at the image's edges, linear
};

#ifdef __cplusplus
}
#endif
#endif
