#version 460
// The rectangles of listed tiles: of their rows of the lattice with the image's width, or of their pixels (ALONG_Y).
#extension GL_GOOGLE_include_directive : require
#include "lattice_tiles.glsl"

layout(scalar, push_constant) uniform Push { ResamplePush push; };
layout(scalar, binding = 3) readonly buffer List { uint tiles[]; };

#define FLAT out
#include "resample_flats.glsl"

// The interpolation for a pixel at sample k reads samples k - 2 to k + 5, and the stencil has widened what they hold by 1. Where the tile on
// one side is not listed, neither that tile nor the one behind it is marked, nor are those above and below them: what is seen of this tile is
// at its other end, in at most 3 samples of its begin or 6 of its end, to which rounding adds up to 3. Pixels that are drawn read no tile that
// is not listed, as nothing is stored there.
const int kSeenOfFirst = 7, kUnseenOfLast = 9;  // samples

// The first pixel of a sample along an axis, or one of up to 3 before it: lavapipe shades blocks of 4x4 pixels. Pixels outside of all tiles
// belong to those on the border.
int pixelOf(int tileSample, int axis) {
  if (tileSample <= frame.firstSeen[axis]) return frame.firstPixel[axis];
  const int end = frame.firstPixel[axis] + frame.pixelExtent[axis];
  if (tileSample >= frame.firstSeen[axis] + frame.seenExtent[axis]) return end;
  const int pixel = int(ceil(float(tileSample - kLatticeMargin) * frame.pitch));
  return clamp(frame.pitch >= 1.0 ? pixel & ~3 : pixel, frame.firstPixel[axis], end);
}

void main() {
  const uint entry = tiles[gl_InstanceIndex];
  const ivec2 tile = firstOfTile(int(entry >> kTileShift));
  ivec2 first = tile, end = tile + kLatticeTile;
  if ((entry & kLeftIsListed) == 0) first.x += kUnseenOfLast;
  if ((entry & kUpperIsListed) == 0) first.y += kUnseenOfLast;
  if ((entry & kRightIsListed) == 0) end.x = tile.x + kSeenOfFirst;
  if ((entry & kLowerIsListed) == 0) end.y = tile.y + kSeenOfFirst;
#ifdef ALONG_Y
  const ivec2 rows = clamp(ivec2(pixelOf(first.y, 1), pixelOf(end.y, 1)), push.firstPixel, push.endPixel);
#else
  const ivec2 rows = clamp(ivec2(first.y, end.y), push.firstRow, push.endRow) - push.firstRow;
#endif
  const ivec2 low = ivec2(pixelOf(first.x, 0), rows.x), high = ivec2(pixelOf(end.x, 0), rows.y);
  // Two triangles, whose corners have these bits set where they are right and below.
  const bvec2 isHigh = bvec2((0x32 >> gl_VertexIndex & 1) != 0, (0x2c >> gl_VertexIndex & 1) != 0);
  pitch = frame.pitch;
#ifdef ALONG_Y
  const int axis = 1;
#else
  const int axis = 0;
#endif
  firstSeen = frame.firstSeen[axis];
  lastSeen = firstSeen + frame.seenExtent[axis] - 1;
  firstRow = push.firstRow;
  rowSamples = frame.samples.x;
  gl_Position = vec4(2.0 * vec2(mix(low, high, isHigh)) / vec2(push.target) - 1.0, 0.0, 1.0);
}
