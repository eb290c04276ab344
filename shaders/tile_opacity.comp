#version 460
// Between the two phases of a frame's drawing, a thread decides for its tile of pixels whether all of them
// are covered: nothing behind what is drawn can then change the image by more than the threshold.
//
// A pixel is covered if two conditions hold. First, the optical depth of what is drawn leaves less than the
// threshold. Second, E is not much less than 1: colours are divided by E, and hidden blocks send less than
// the threshold, so that the mix stays as it is. A small E means that every voxel on the pixel's ray is dark
// in the table, which has no direction through the opening that the pixel looks through; then all of them
// count.
#extension GL_GOOGLE_include_directive : require
#include "world_per_index.glsl"

const float kMinEnergy = 0.25;

layout(local_size_x = kCoverThreads) in;
layout(scalar, push_constant) uniform Push { TilePush push; };
layout(scalar, binding = 0) readonly buffer Counts { CutCounts counts; };
layout(scalar, binding = 1) writeonly buffer Tiles { uint tiles[]; };
layout(binding = 2, rgba32f) readonly uniform image2D colorEnergy;
layout(binding = 3, r32f) readonly uniform image2D opticalDepth;

bool isCoveredPixel(ivec2 pixel) {
  const float scale = worldPerIndex(push.rays, pixel);
  return imageLoad(opticalDepth, pixel).r * scale >= push.hiddenDepth &&
         imageLoad(colorEnergy, pixel).a * scale >= kMinEnergy;
}

void main() {
  if (counts.deferred == 0) return;
  const uint tile = gl_GlobalInvocationID.x;
  if (tile >= push.tiles.x * push.tiles.y) return;
  const ivec2 first = kCoverTile * ivec2(tile % push.tiles.x, tile / push.tiles.x);
  const ivec2 end = min(first + kCoverTile, push.rays.size);
  // Most tiles that are not covered are so from their first pixel on.
  bool covered = true;
  for (int y = first.y; y < end.y && covered; ++y)
    for (int x = first.x; x < end.x && covered; ++x) covered = isCoveredPixel(ivec2(x, y));
  tiles[tile] = covered ? 1 : 0;
}
