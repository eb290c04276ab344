#version 460
// Second of two passes that list the tiles of which the image is drawn: those that are marked and those beside these, in any order. The
// stencil and the interpolation reach less than a tile.
#extension GL_GOOGLE_include_directive : require
#include "lattice_tiles.glsl"

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;
layout(scalar, binding = 1) readonly buffer Marks { uint marks[]; };
layout(scalar, binding = 2) buffer Sizes { DrawSize draw; DispatchSize ranges[]; };
layout(scalar, binding = 3) writeonly buffer List { uint tiles[]; };

bool isListed(ivec2 tile) {
  const ivec2 extent = tilesOfLattice(), low = max(tile - 1, ivec2(0)), high = min(tile + 1, extent - 1);
  uint found = 0;
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) found |= marks[x + y * extent.x];
  return found != 0;
}

void main() {
  const ivec2 tile = ivec2(gl_GlobalInvocationID.xy), extent = tilesOfLattice();
  if (any(greaterThanEqual(tile, extent)) || !isListed(tile)) return;
  uint entry = uint(tile.x + tile.y * extent.x) << kTileShift;
  if (isListed(tile - ivec2(1, 0))) entry |= kLeftIsListed;
  if (isListed(tile + ivec2(1, 0))) entry |= kRightIsListed;
  if (isListed(tile - ivec2(0, 1))) entry |= kUpperIsListed;
  if (isListed(tile + ivec2(0, 1))) entry |= kLowerIsListed;
  const uint place = atomicAdd(draw.instances, 1);
  tiles[place] = entry;
  atomicAdd(ranges[place / kTilesOfARange].y, 1);
}
