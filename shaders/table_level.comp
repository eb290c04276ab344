#version 460
// A level of the octree's attenuation table from the one below, for a few directions, a thread a block that holds
// anything: Subr et al. 2007, Section 3.2, Eq. 7. The geometric mean of transmittances is the mean of optical depths.
// Children that hold nothing or are outside of the volume do not count, the others as much as they have voxels.
//
// And its bounds: the code of the most transparent voxel, which says what can be left out behind others. Those of level 1
// are for pack_bounds.comp.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#include "interface.h"
#include "attenuation_code.glsl"
#include "blocks.glsl"
#include "rank.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;
layout(constant_id = 1) const int kFilter = kFilterGeometric;
layout(constant_id = 2) const int kChildren = kChildrenBlocks;

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { TableLevelPush push; };
// By direction, of all voxels: the code of the most opaque, of linear8 255 minus it.
layout(scalar, binding = 0) buffer Darkest { uint darkest[]; };
layout(binding = 1) uniform utextureBuffer occupancy;  // an OccupancyWord a texel
layout(scalar, binding = 2) readonly buffer Parents { uint parents[]; };
// A direction's codes, read and written.
#define PLANE(i)                                                \
  layout(binding = 3 + i) uniform utextureBuffer read##i;      \
  layout(scalar, binding = 3 + kDirectionsPerLevelPass + i) writeonly buffer Plane##i { uint8_t codes[]; } plane##i;
PLANE(0) PLANE(1) PLANE(2) PLANE(3) PLANE(4) PLANE(5) PLANE(6)
// The bounds of the blocks of level 1, a byte each: of a direction of the pass behind those of the one before.
layout(scalar, binding = 3 + 2 * kDirectionsPerLevelPass) buffer OwnBounds { uint8_t ownBounds[]; };

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

// The children: their ranks, and how many voxels they have; none of those that hold nothing.
uint ranks[8];
float voxels[8];

void findChildren(ivec3 cell) {
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const ivec3 child = 2 * cell + ivec3(0, row & 1, row >> 1);
    const bool exists = all(lessThan(child, push.child.dimensions));
    const ivec3 inside = extentInside(child, push.childEdge, push.voxels);
    // Two that are neighbours in x are in one word.
    const uint address = exists ? blockAddress(push.child, child) : 0;
    const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
    const int bit = int(address % kBlocksPerWord);
    uint rank = push.child.firstRank + rankIn(word, bit);
    [[unroll]] for (int x = 0; x < 2; ++x) {
      const bool holds = exists && (word.x >> (bit + x) & 1u) != 0;
      const int width = min(push.voxels.x - (child.x + x) * push.childEdge, push.childEdge);
      ranks[2 * row + x] = holds ? rank : push.child.firstRank;
      voxels[2 * row + x] = holds ? float(width) * float(inside.y) * float(inside.z) : 0.0;
      rank += holds ? 1 : 0;
    }
  }
}

struct Parent {
  uint code, bound, darkest;
};

uint boundOfChild(utextureBuffer codes, uint code, uint rank, uint direction) {
  if (kChildren == kChildrenVoxels) return code;
  const uint place = rank - push.child.firstRank, count = push.parent.firstRank - push.child.firstRank;
  if (kChildren == kChildrenPacked) return uint(ownBounds[direction * count + place]);
  return texelFetch(codes, int(push.child.firstBound + place)).x;
}

Parent parentOf(utextureBuffer codes, uint direction) {
  float sum = 0.0, all = 0.0;
  uint used = 0;
  Parent parent = Parent(0, kDarkest, 0);
  [[unroll]] for (int child = 0; child < 8; ++child) {
    const bool holds = voxels[child] > 0.0;
    const uint code = texelFetch(codes, int(ranks[child])).x;
    const uint bound = boundOfChild(codes, code, ranks[child], direction);
    sum += voxels[child] * filtered(code);
    all += voxels[child];
    used |= holds ? code : 0;
    parent.bound = holds ? clearer(parent.bound, bound) : parent.bound;
    parent.darkest = holds ? max(parent.darkest, darkness(code)) : parent.darkest;
  }
  if (used != 0) parent.code = codeOf(sum / all);  // what all children store as 0 is 0
  return parent;
}

#define MAKE(i)                                                                                   \
  if (i < push.directionCount) {                                                                  \
    const Parent parent = parentOf(read##i, i);                                                   \
    plane##i.codes[push.parent.firstRank + block] = uint8_t(parent.code);                         \
    if (kChildren == kChildrenVoxels)                                                             \
      ownBounds[i * push.parentCount + block] = uint8_t(parent.bound);                            \
    else                                                                                          \
      plane##i.codes[push.parent.firstBound + block] = uint8_t(parent.bound);                     \
    /* Few are darker than all before them. */                                                    \
    if (kChildren == kChildrenVoxels && parent.darkest > darkest[push.firstDirection + i])        \
      atomicMax(darkest[push.firstDirection + i], parent.darkest);                                \
  }

void main() {
  const uint block = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kLevelThreads;
  if (block >= push.parentCount) return;
  findChildren(cellAt(push.parent, parents[block]));
  MAKE(0) MAKE(1) MAKE(2) MAKE(3) MAKE(4) MAKE(5) MAKE(6)
}
