// World length of a pixel's ray per index length: the factor of the footprints that is left out of a pixel's sums (splat.frag).
#ifndef WORLD_PER_INDEX_GLSL
#define WORLD_PER_INDEX_GLSL
#include "frame_interface.h"

float worldPerIndex(ResolvePush rays, ivec2 pixel) {
  const vec2 position = vec2(pixel) + 0.5 - 0.5 * vec2(rays.size);
  return length(rays.worldRay + position.x * rays.worldRayX + position.y * rays.worldRayY) /
         length(rays.ray + position.x * rays.rayX + position.y * rays.rayY);
}

#endif
