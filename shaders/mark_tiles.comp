#version 460
// Marks the tiles of the image that the splats of a chunk reach, so that accumulate_sums.comp reads no
// others.
#extension GL_GOOGLE_include_directive : require
#include "share_interface.h"

layout(local_size_x = kSplatThreads) in;
layout(scalar, push_constant) uniform Push { MarkPush push; };
layout(scalar, binding = 0) readonly buffer Splats { Splat splats[]; };
layout(scalar, binding = 1) readonly buffer Chunks { ChunkArguments chunks[]; };
layout(scalar, binding = 2) buffer Reached { uint reached[]; };  // a tile each, row by row: 1 if it is in the list
layout(scalar, binding = 3) writeonly buffer Tiles { uint tiles[]; };
layout(scalar, binding = 4) buffer Arguments { TileArguments arguments; };

void main() {
  const uint local = gl_GlobalInvocationID.x;
  if (local >= chunks[push.chunk].splatCount) return;
  if (local == 0) arguments.groupsY = arguments.groupsZ = 1;
  const vec2 halfExtent = splats[local].halfExtent;
  if (halfExtent == vec2(0.0)) return;
  // A point is a square; a pixel more for the rasteriser's rounding.
  const vec2 reach = vec2(max(halfExtent.x, halfExtent.y) + 1.0);
  const vec2 center = splats[local].center + push.imageMiddle, last = vec2(push.tiles - 1);
  const ivec2 low = ivec2(clamp(floor((center - reach) / float(kResolveTile)), vec2(0.0), last));
  const ivec2 high = ivec2(clamp(floor((center + reach) / float(kResolveTile)), vec2(0.0), last));
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      const uint tile = uint(x + push.tiles.x * y);
      if (reached[tile] != 0 || atomicExchange(reached[tile], 1u) != 0) continue;
      const uint place = atomicAdd(arguments.tileCount, 1);
      tiles[place] = tile;
      atomicMax(arguments.groupsX, min(place + 1, uint(kMaxTileGroups)));
    }
}
