#ifndef FREEVOXELS_DISPLAY_INTERFACE_H
#define FREEVOXELS_DISPLAY_INTERFACE_H
// Constants and structs of the display pass that C++ and GLSL share, as those of interface.h.
#include "interface.h"

#ifdef __cplusplus
namespace freevoxels::shader {
#endif

// The table from linear light to sRGB bytes (engine/image/srgb.h) has a bucket for the floats that share all but their
// lowest kSrgbDroppedBits bits, beginning with 2^-13; smaller ones are byte 0. Floats from 1 on are byte 255. In a bucket's word are the
// byte of its first floats, and in the lowest kSrgbByteShift bits the dropped bits from which on floats have the next byte.
FV_CONSTANT uint kSrgbFirstBits = 0x39000000u;
FV_CONSTANT uint kSrgbEndBits = 0x3f800000u;
FV_CONSTANT int kSrgbDroppedBits = 16;
FV_CONSTANT int kSrgbByteShift = kSrgbDroppedBits + 1;
FV_CONSTANT uint kSrgbDroppedMask = (1u << kSrgbDroppedBits) - 1u;
FV_CONSTANT uint kSrgbNextMask = (1u << kSrgbByteShift) - 1u;

// As ToneMap of engine/image/image.h.
FV_CONSTANT int kToneMapNone = 0;
FV_CONSTANT int kToneMapFilmic = 1;
FV_CONSTANT int kToneMapAces = 2;

struct DisplayPush {
  int height;           // of the image, pixels
  float gain;           // 2^exposure
  vec3 top, bottom;     // the background at the image's edges, linear
};

#ifdef __cplusplus
}
#endif
#endif
