#version 460
// Interpolates the samples of smooth cells, and counts those of the others, by workgroup, for the list of samples that are marched.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define ROUGHNESS_BINDING 5
#include "gather_rough_cells.glsl"

layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2) uniform textureBuffer distances;    // sum of e times distance
layout(binding = 3, rgba32f) writeonly uniform imageBuffer colorEnergyOut;
layout(binding = 4, r32f) writeonly uniform imageBuffer distancesOut;
layout(scalar, binding = 6) writeonly buffer GroupCounts { uint groupCounts[]; };

shared uint total;

// Catmull-Rom interpolation in the middle between b and c.
vec4 middle(vec4 a, vec4 b, vec4 c, vec4 d) { return (9.0 * (b + c) - a - d) / 16.0; }

// `around` has the sums of E and of e times distance of the coarse samples nearest to this one, whose mean distance it takes. Where they
// have no E, as in flames without smoke, it has none either.
void setSample(int place, vec4 color, vec2 around) {
  color = max(color, vec4(0.0));
  if (around.x <= 0.0) color.a = 0.0;
  imageStore(colorEnergyOut, place, color);
  imageStore(distancesOut, place, vec4(color.a * around.y / max(around.x, 1e-30)));
}

void interpolate(ivec2 cell, int first) {
  // Each of the four rows of coarse samples around the cell has a value in the middle of the cell along x, and a sample at its begin.
  vec4 middles[4], begins[4];
  vec2 corners[4];  // E, and the sum of e times distance, at the cell's corners
  [[unroll]] for (int j = 0; j < 4; ++j) {
    vec4 row[4];
    [[unroll]] for (int i = 0; i < 4; ++i) row[i] = texelFetch(colorEnergy, placeOfCoarse(cell + ivec2(i, j) - 1));
    middles[j] = middle(row[0], row[1], row[2], row[3]);
    begins[j] = row[1];
    if (j == 1 || j == 2)
      [[unroll]] for (int i = 0; i < 2; ++i)
        corners[2 * (j - 1) + i] = vec2(row[1 + i].a, texelFetch(distances, placeOfCoarse(cell + ivec2(i, j - 1))).x);
  }
  setSample(first + 1, middles[1], corners[0] + corners[1]);
  setSample(first + frame.samples.x, middle(begins[0], begins[1], begins[2], begins[3]), corners[0] + corners[2]);
  setSample(first + frame.samples.x + 1, middle(middles[0], middles[1], middles[2], middles[3]),
            corners[0] + corners[1] + corners[2] + corners[3]);
}

void main() {
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (gl_LocalInvocationIndex == 0) total = 0;
  barrier();
  const uint count = countOfListed(cell);
  atomicAdd(total, count);
  const bool isOwn = cell.y >= frame.ownCells.x && cell.y < frame.ownCells.y;
  if (isOwn && all(lessThan(cell, coarseExtent() - 1)) && count == 0) interpolate(cell, placeOfCoarse(cell));
  barrier();
  if (gl_LocalInvocationIndex == 0) groupCounts[gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x] = total;
}
