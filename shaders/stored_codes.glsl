// Stores the codes of a direction for the occupied voxels, at their ranks. Takes the bindings 1 and 2.
#ifndef STORED_CODES_GLSL
#define STORED_CODES_GLSL
#extension GL_EXT_shader_8bit_storage : require
#include "attenuation_code.glsl"
#include "interface.h"
#include "rank.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;  // of the table

layout(scalar, binding = 1) writeonly buffer Plane { uint8_t codes[]; };
layout(binding = 2) uniform utextureBuffer occupancy;  // an OccupancyWord a texel

// Writes the codes of four voxels of a row.
void storeCodes(int quad, vec4 depths) {
  const uvec2 word = texelFetch(occupancy, quad / (kBlocksPerWord / 4)).xy;  // mask, before
  const int first = 4 * quad % kBlocksPerWord;
  const uint bits = bitfieldExtract(word.x, first, 4);
  if (bits == 0) return;
  uint rank = rankIn(word, first);
  [[unroll]] for (int c = 0; c < 4; ++c)
    if ((bits >> c & 1u) != 0) codes[rank++] = uint8_t(encodeDepth(kCode, depths[c]));
}

#endif
