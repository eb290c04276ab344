#version 460
// The fraction of the ambient light that reaches the centres of all blocks of bricks, interpolated between
// cells (ambient_sweep.comp). It is stored as the optical depth that a single light would have passed, so
// that it changes as fast as that towards opaque parts. A workgroup for each brick, a thread for each row of
// blocks.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { AmbientCodesPush push; };
layout(binding = 0) uniform utextureBuffer brickCells;  // position of each brick's first block, in blocks: x, y, z
layout(binding = 1) uniform textureBuffer light;  // of the cells
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Codes { uint pairs[]; };

float lightAt(ivec3 block) {
  const vec3 position = ((vec3(block) + 0.5) * float(push.blockEdge)) / float(push.cellEdge) - 0.5;
  const vec3 low = floor(position), upperShare = position - low;
  float sum = 0.0;
  [[unroll]] for (int corner = 0; corner < 8; ++corner) {
    const ivec3 upper = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const ivec3 cell = clamp(ivec3(low) + upper, ivec3(0), push.cells - 1);
    const vec3 shares = mix(1.0 - upperShare, upperShare, vec3(upper));
    const int place = cell.x + push.cells.x * (cell.y + push.cells.y * cell.z);
    float part = texelFetch(light, place + push.firstLight).x;
    if (push.firstWeight >= 0) part /= texelFetch(light, place + push.firstWeight).x;
    sum += shares.x * shares.y * shares.z * part;
  }
  return sum;
}

float codeOf(float light) { return sqrt(clamp(-log(light) / kOpaqueDepth, 0.0, 1.0)); }

void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const int row = int(gl_LocalInvocationIndex);
  const ivec3 first = push.firstBlock + ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz) +
                      ivec3(0, row % kGatherBrickEdge, row / kGatherBrickEdge);
  const uint pair = ((push.firstBrick + brick) * kGatherBrickBlocks + row * kGatherBrickEdge) / 2;
  for (int x = 0; x < kGatherBrickEdge; x += 2)
    Codes(push.codes).pairs[pair + x / 2] =
        packUnorm2x16(vec2(codeOf(lightAt(first + ivec3(x, 0, 0))), codeOf(lightAt(first + ivec3(x + 1, 0, 0)))));
}
