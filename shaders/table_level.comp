#version 460
// A level of the octree's attenuation table from the one below, for one direction, a thread eight blocks: Subr et
// al. 2007, Section 3.2, Eq. 7. The geometric mean of transmittances is the mean of optical depths. Children
// outside of the volume do not count, the others as much as they have voxels.
//
// And its bounds: the code of the most transparent voxel of each block, which says what can be left out behind others.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "attenuation_code.glsl"
#include "blocks.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;
layout(constant_id = 1) const int kFilter = kFilterGeometric;
layout(constant_id = 2) const bool kFromVoxels = false;  // whose codes are their own bounds

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { TableLevelPush push; };
layout(binding = 0) uniform utextureBuffer codes;  // sixteen a texel
layout(scalar, binding = 1) writeonly buffer Plane { uint words[]; };
// By direction, of all voxels: the code of the most opaque, of linear8 255 minus it.
layout(scalar, binding = 2) buffer Darkest { uint darkest[]; };

const bool kSquares = kCode == kCodeDepth8 && kFilter == kFilterGeometric;  // depths are as the squares of codes

// What the filter takes the mean of. A transmittance that is stored as 0 counts as half the smallest code: it is
// less than a whole one, and -infinity would be all that is left of any mean.
float filtered(uint byte) {
  if (kSquares) return float(byte) * float(byte);
  const float depth = kCode == kCodeLinear8 && byte == 0 ? log(2.0 * 255.0) : decodeDepth(kCode, byte);
  return kFilter == kFilterGeometric ? depth : exp(-depth);
}
uint codeOf(float mean) {
  if (kSquares) return uint(sqrt(mean) + 0.5);
  return encodeDepth(kCode, kFilter == kFilterGeometric ? mean : -log(mean));
}
// Of the two, the one of more transmittance.
uint clearer(uint a, uint b) { return kCode == kCodeLinear8 ? max(a, b) : min(a, b); }
uint darkness(uint code) { return kCode == kCodeLinear8 ? 255 - code : code; }
const uint kDarkest = kCode == kCodeLinear8 ? 0 : 255;

void main() {
  const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kLevelThreads;
  if (i >= push.threadCount) return;
  const uint address = push.parent.first + kLevelBlocksPerThread * i;
  const ivec3 cell = cellAt(push.parent, address);

  // The part of its block that a column of children has; and of a row, in voxels.
  float columns[2 * kLevelBlocksPerThread];
  [[unroll]] for (int c = 0; c < 2 * kLevelBlocksPerThread; ++c)
    columns[c] = float(clamp(push.voxels.x - (2 * cell.x + c) * push.childEdge, 0, push.childEdge));
  const ivec3 inside = extentInside(cell, 2 * push.childEdge, push.voxels);
  float sums[kLevelBlocksPerThread];
  uint used[kLevelBlocksPerThread], clearest[kLevelBlocksPerThread];
  [[unroll]] for (int block = 0; block < kLevelBlocksPerThread; ++block) {
    sums[block] = 0.0;
    used[block] = 0;
    clearest[block] = kDarkest;
  }
  uint darkestHere = 0;
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const ivec3 child = 2 * cell + ivec3(0, row & 1, row >> 1);
    const ivec2 rows = max(extentInside(child, push.childEdge, push.voxels).yz, 0);
    const float share = float(rows.x) / float(inside.y) * (float(rows.y) / float(inside.z));
    // Where there is no child any other is read instead, for nothing.
    const ivec3 read = ivec3(child.x < push.child.rowPitch ? child.x : 0, min(child.yz, push.child.dimensions.yz - 1));
    const uvec4 texel = texelFetch(codes, int(blockAddress(push.child, read) / 16));
    const uvec4 bounds =
        kFromVoxels ? texel : texelFetch(codes, int((blockAddress(push.child, read) + push.boundsOffset) / 16));
    [[unroll]] for (int block = 0; block < kLevelBlocksPerThread; ++block) {
      const uint two = texel[block / 2] >> (16 * (block % 2));
      const uint low = two & 255, high = two >> 8 & 255;
      sums[block] += share * (columns[2 * block] * filtered(low) + columns[2 * block + 1] * filtered(high));
      if (!kSquares && share > 0.0) used[block] |= low | (columns[2 * block + 1] > 0.0 ? high : 0);
      if (share <= 0.0) continue;
      const uint twoBounds = bounds[block / 2] >> (16 * (block % 2));
      if (columns[2 * block] > 0.0) {
        clearest[block] = clearer(clearest[block], twoBounds & 255);
        darkestHere = max(darkestHere, darkness(low));
      }
      if (columns[2 * block + 1] > 0.0) {
        clearest[block] = clearer(clearest[block], twoBounds >> 8 & 255);
        darkestHere = max(darkestHere, darkness(high));
      }
    }
  }
  [[unroll]] for (int w = 0; w < kLevelBlocksPerThread / 4; ++w) {
    uint word = 0, bounds = 0;
    [[unroll]] for (int b = 0; b < 4; ++b) {
      const int block = 4 * w + b;
      const float mean = sums[block] / max(columns[2 * block] + columns[2 * block + 1], 1.0);
      if (kSquares || used[block] != 0) word |= codeOf(mean) << (8 * b);  // what all children store as 0 is 0
      bounds |= clearest[block] << (8 * b);
    }
    words[address / 4 + w] = word;
    words[(address + push.boundsOffset) / 4 + w] = bounds;
  }
  // Few are darker than all before them.
  if (kFromVoxels && darkestHere > darkest[push.direction]) atomicMax(darkest[push.direction], darkestHere);
}
