#version 460
// The bounds of the blocks of level 1, as table_level.comp made them, kBoundBlocks to a byte of the table: a thread a byte.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "interface.h"
#include "attenuation_code.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { TableLevelPush push; };  // that of level 1
layout(scalar, binding = 0) readonly buffer OwnBounds { uint8_t ownBounds[]; };
#define PLANE(i) \
  layout(scalar, binding = 1 + i) writeonly buffer Plane##i { uint8_t codes[]; } plane##i;
PLANE(0) PLANE(1) PLANE(2) PLANE(3) PLANE(4) PLANE(5) PLANE(6)

uint boundsIn(uint byte, uint direction) {
  uint bounds = kCode == kCodeDepth8 ? 255 : 0;  // the darkest, where there is no block
  [[unroll]] for (uint i = 0; i < kBoundBlocks; ++i) {
    const uint block = kBoundBlocks * byte + i;
    if (block < push.parentCount)
      bounds = bitfieldInsert(bounds, packBound(kCode, uint(ownBounds[direction * push.parentCount + block])), int(4 * i), 4);
  }
  return bounds;
}

#define STORE(i) \
  if (i < push.directionCount) plane##i.codes[push.parent.firstBound + byte] = uint8_t(boundsIn(byte, i));

void main() {
  const uint byte = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kLevelThreads;
  if (kBoundBlocks * byte >= push.parentCount) return;
  STORE(0) STORE(1) STORE(2) STORE(3) STORE(4) STORE(5) STORE(6)
}
