#version 460
// First of two passes that list the tiles of which the image is drawn: marks those that hold a sample with C or E. A workgroup for each tile.
// Also sets the sizes of what is then drawn and dispatched to nothing.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lattice_tiles.glsl"

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(binding = 1) uniform textureBuffer colorEnergy;                // C, E
layout(scalar, binding = 2) writeonly buffer Marks { uint marks[]; };  // of tiles; 0 before
layout(scalar, binding = 3) writeonly buffer Sizes { DrawSize draw; DispatchSize ranges[]; };

void main() {
  const uint tile = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  const ivec2 first = firstOfTile(int(tile)) + ivec2(gl_LocalInvocationID.xy);
  vec4 largest = vec4(0.0);
  for (int y = 0; y < kLatticeTile; y += kGatherTile)
    for (int x = 0; x < kLatticeTile; x += kGatherTile)
      largest = max(largest, abs(texelFetch(colorEnergy, placeOfSample(first + ivec2(x, y)))));
  if (any(greaterThan(largest, vec4(0.0)))) marks[tile] = 1;
  if (gl_LocalInvocationIndex != 0) return;
  if (tile == 0) draw = DrawSize(6, 0, 0, 0);
  if (tile < uint(ranges.length())) ranges[tile] = DispatchSize((kLatticeTile / kGatherTile) * (kLatticeTile / kGatherTile), 0, 1);
}
