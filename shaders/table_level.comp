#version 460
// A level of the octree's attenuation table from the one below, for one direction, a thread eight blocks: Subr et
// al. 2007, Section 3.2, Eq. 7. The geometric mean of transmittances is the mean of optical depths. Children
// outside of the volume do not count, the others as much as they have voxels.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "attenuation_code.glsl"
#include "blocks.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;
layout(constant_id = 1) const int kFilter = kFilterGeometric;

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { TableLevelPush push; };
layout(binding = 0) uniform utextureBuffer codes;  // sixteen a texel
layout(scalar, binding = 1) writeonly buffer Plane { uint words[]; };

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
  uint used[kLevelBlocksPerThread];
  [[unroll]] for (int block = 0; block < kLevelBlocksPerThread; ++block) {
    sums[block] = 0.0;
    used[block] = 0;
  }
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const ivec3 child = 2 * cell + ivec3(0, row & 1, row >> 1);
    const ivec2 rows = max(extentInside(child, push.childEdge, push.voxels).yz, 0);
    const float share = float(rows.x) / float(inside.y) * (float(rows.y) / float(inside.z));
    // Where there is no child any other is read instead, for nothing.
    const ivec3 read = ivec3(child.x < push.child.rowPitch ? child.x : 0, min(child.yz, push.child.dimensions.yz - 1));
    const uvec4 texel = texelFetch(codes, int(blockAddress(push.child, read) / 16));
    [[unroll]] for (int block = 0; block < kLevelBlocksPerThread; ++block) {
      const uint two = texel[block / 2] >> (16 * (block % 2));
      const uint low = two & 255, high = two >> 8 & 255;
      sums[block] += share * (columns[2 * block] * filtered(low) + columns[2 * block + 1] * filtered(high));
      if (!kSquares && share > 0.0) used[block] |= low | (columns[2 * block + 1] > 0.0 ? high : 0);
    }
  }
  [[unroll]] for (int w = 0; w < kLevelBlocksPerThread / 4; ++w) {
    uint word = 0;
    [[unroll]] for (int b = 0; b < 4; ++b) {
      const int block = 4 * w + b;
      const float mean = sums[block] / max(columns[2 * block] + columns[2 * block + 1], 1.0);
      if (kSquares || used[block] != 0) word |= codeOf(mean) << (8 * b);  // what all children store as 0 is 0
    }
    words[address / 4 + w] = word;
  }
}
