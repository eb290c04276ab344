// Whether a block is hidden by what is already drawn, by the tiles of tile_opacity.comp.
#ifndef COVERED_BLOCK_GLSL
#define COVERED_BLOCK_GLSL
#include "cut_frame.glsl"

layout(scalar, binding = 9) readonly buffer Tiles { uint tiles[]; };

const int kMaxTiles = 8;  // along an axis; the tiles of a larger block are tested in parts

// Whether every pixel that anything in the block can reach is covered. `center` is relative to the volume's
// middle.
bool isOccluded(vec3 center, int edge) {
  // Elements drawn in the block are no larger than the frame's coarsest block, and centred between its
  // voxels' centres.
  const float reach = 0.5 * float(edge - 1) + kSplatRadius * float(min(edge, 1 << frame.coarsest));
  const vec3 projected = frame.indexToPixel * center + frame.middleInPixels;
  const mat3 rows = transpose(frame.indexToPixel);
  vec2 pixel = projected.xy;
  vec2 steepest = vec2(dot(abs(rows[0]), vec3(1.0)), dot(abs(rows[1]), vec3(1.0)));
  if (frame.orthographic == 0) {
    const float nearest = projected.z - reach * dot(abs(rows[2]), vec3(1.0));
    if (nearest <= 0.0) return false;
    pixel /= projected.z;
    steepest = vec2(dot(abs(rows[0] - pixel.x * rows[2]), vec3(1.0)), dot(abs(rows[1] - pixel.y * rows[2]), vec3(1.0))) /
               nearest;
  }
  pixel += frame.imageMiddle;
  // Margin for widened footprints, which reach farther, and for rounding.
  const vec2 half_ = reach * steepest + kSplatRadius + 0.5;
  const ivec2 first = ivec2(clamp(floor((pixel - half_) / float(kCoverTile)), vec2(0.0), vec2(frame.tiles)));
  const ivec2 end = ivec2(clamp(floor((pixel + half_) / float(kCoverTile)) + 1.0, vec2(0.0), vec2(frame.tiles)));
  if (any(greaterThan(end - first, ivec2(kMaxTiles)))) return false;
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x)
      if (tiles[y * frame.tiles.x + x] == 0) return false;
  return true;
}

#endif
