#version 460
// Lists the samples of rough cells, which are to be marched, and interpolates those of the others. A cell is rough if one of its
// coarse samples is.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "gather_adaptive.glsl"

layout(binding = 1) uniform textureBuffer colorEnergy;  // C, E
layout(binding = 2) uniform textureBuffer distances;    // sum of e times distance
layout(binding = 3, rgba32f) writeonly uniform imageBuffer colorEnergyOut;
layout(binding = 4, r32f) writeonly uniform imageBuffer distancesOut;
layout(binding = 5) uniform textureBuffer roughness;
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SampleList { SampleListHead head; uint samples[]; };
layout(push_constant, scalar) uniform Push { SamplesPush push; };

bool isRough(ivec2 cell) {
  const int row = coarseExtent().x;
  float largest = 0.0;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const ivec2 at = cell + ivec2(i & 1, i >> 1);
    largest = max(largest, texelFetch(roughness, at.x + at.y * row).x);
  }
  return largest > frame.sampleTolerance;
}

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

void listSample(SampleList list, int place) {
  const uint number = atomicAdd(list.head.count, 1u), samplesOfARow = uint(push.groupsOfARow * kGatherTile * kGatherTile);
  list.samples[number] = uint(place);
  if (number % samplesOfARow != 0u) return;
  const uint row = number / samplesOfARow, rows = uint(push.rowsOfARange);
  atomicMax(list.head.ranges[row / rows].y, row % rows + 1u);
}

// Cells of the last column and row have only the samples that are stored.
void main() {
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, coarseExtent()))) return;
  const bvec2 inside = lessThan(cell, coarseExtent() - 1);
  const int first = placeOfCoarse(cell);
  if (all(inside) && !isRough(cell)) {
    interpolate(cell, first);
    return;
  }
  SampleList list = SampleList(push.list);
  if (inside.x) listSample(list, first + 1);
  if (inside.y) listSample(list, first + frame.samples.x);
  if (all(inside)) listSample(list, first + frame.samples.x + 1);
}
