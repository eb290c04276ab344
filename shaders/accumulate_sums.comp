#version 460
// Adds the sums of one share (32-bit floats) to those of all shares (64-bit fixed point), and clears the
// former for the next share. Each share's sum of a pixel is rounded once; integers are added exactly, so
// their order does not matter. Only the tiles that the share's splats reach are read (mark_tiles.comp).
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "fixed_point.glsl"
#include "world_per_index.glsl"

layout(constant_id = 0) const bool kWithDistance = false;

layout(local_size_x = kResolveTile, local_size_y = kResolveTile) in;
layout(scalar, push_constant) uniform Push { AccumulatePush push; };
layout(binding = 0, rgba32f) uniform image2D colorEnergy;
layout(binding = 1, r32f) uniform image2D opticalDepth;
layout(binding = 2, r32f) uniform image2D weightedDistance;
layout(scalar, binding = 3) buffer Overflow { uint overflow; };  // 1: some value was not finite
layout(scalar, binding = 4) buffer Reached { uint reached[]; };
layout(scalar, binding = 5) readonly buffer Tiles { uint tiles[]; };
layout(scalar, binding = 6) readonly buffer Arguments { TileArguments arguments; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Sums { uvec2 values[]; };

const float kMaxOfRange = 0.99;  // less than 1 by more than rounding

// 1, or less where C or E is beyond its range: in normalised images the E of an extremely dense surface has no bound, but colours are
// weighted means of C / E, so it is enough to keep their ratio.
float reduction(vec4 sums) {
  const float color = max(sums.r, max(sums.g, sums.b)) * exp2(float(push.colorDigits - kSumBits));
  const float most = max(color, sums.a * exp2(float(push.energyDigits - kSumBits)));
  return most > kMaxOfRange ? kMaxOfRange / most : 1.0;
}

void add(uint channel, uint pixel, float x, int digits, inout bool fits) {
  if (x == 0.0) return;
  const uint place = channel * uint(push.extent.x * push.extent.y) + pixel;
  Sums sums = Sums(push.sums);
  sums.values[place] = addFixed(sums.values[place], x, digits, fits);
}

void accumulate(ivec2 pixel) {
  const ivec2 place = pixel - push.first;
  if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, push.extent))) return;
  const vec4 color = imageLoad(colorEnergy, pixel);
  const float depth = imageLoad(opticalDepth, pixel).r;
  if (color == vec4(0.0) && depth == 0.0) return;
  const float scale = worldPerIndex(push.rays, pixel);
  const uint index = uint(place.x + push.extent.x * place.y);
  const vec4 sums = color * scale;
  const float reduced = reduction(sums);
  bool fits = true;
  for (uint c = 0; c < 3; ++c) add(c, index, sums[c] * reduced, push.colorDigits, fits);
  add(3, index, sums.a * reduced, push.energyDigits, fits);
  bool opaque = true;  // beyond the range of the optical depth no light comes through: it may stay at its end
  add(4, index, depth * scale, push.depthDigits, opaque);
  if (kWithDistance) {
    add(5, index, imageLoad(weightedDistance, pixel).r * scale * reduced, push.distanceDigits, fits);
    imageStore(weightedDistance, pixel, vec4(0.0));
  }
  imageStore(colorEnergy, pixel, vec4(0.0));
  imageStore(opticalDepth, pixel, vec4(0.0));
  if (!fits) atomicOr(overflow, 1u);
}

void main() {
  const uint tilesInRow = uint(push.rays.size.x + kResolveTile - 1) / kResolveTile;
  for (uint i = gl_WorkGroupID.x; i < arguments.tileCount; i += gl_NumWorkGroups.x) {
    const uint tile = tiles[i];
    accumulate(kResolveTile * ivec2(tile % tilesInRow, tile / tilesInRow) + ivec2(gl_LocalInvocationID.xy));
    if (gl_LocalInvocationIndex == 0) reached[tile] = 0;
  }
}
