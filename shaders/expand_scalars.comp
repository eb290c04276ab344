#version 460
// Writes the scalars of all voxels of a box, which may reach beyond the volume, as intervals of the transfer
// function's table; negative without data. A thread writes four voxels of a row, which are in the same brick.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#define CODE_TEXELS_BINDING 1
#define CODE_TEXELS_CONSTANT 0
#include "code_bricks.glsl"

layout(local_size_x = kExpandTile, local_size_y = kExpandTile) in;
layout(scalar, push_constant) uniform Push { ExpandScalarsPush push; };
layout(binding = 0, rgba32f) writeonly uniform imageBuffer boxScalars;

void main() {
  const ivec3 place = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(place, push.extent))) return;
  const ivec3 voxel = push.first + ivec3(4 * place.x, place.yz);
  const int nearest = clamp(voxel.x, 0, push.dimensions.x - 1);
  const uvec2 pairs = codePairs(push.scalars, codeBrick(push.scalars, push.dimensions, ivec3(nearest, voxel.yz)), voxel);
  vec4 quad;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const bool inside = voxel.x + i >= 0 && voxel.x + i < push.dimensions.x;
    quad[i] = scalarOfCode(inside ? bitfieldExtract(pairs[i >> 1], (i & 1) * 16, 16) : 0);
  }
  imageStore(boxScalars, place.x + push.extent.x * (place.y + push.extent.y * place.z), quad);
}
