#version 460
// Computes levels of the octree's attenuation table, each from the one below, for a few directions; a part is
// kBoundBlocks occupied blocks: Subr et al. 2007, Section 3.2, Eq. 7. The geometric mean of transmittances is
// the mean of optical depths. Only occupied children count, weighted by their numbers of voxels inside the
// volume.
//
// Also computes the bounds: the code of a block's most transparent voxel, by which hidden blocks are found.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_KHR_memory_scope_semantics : require
#include "interface.h"
#include "attenuation_code.glsl"
#include "rank.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;
layout(constant_id = 1) const int kFilter = kFilterGeometric;
layout(constant_id = 2) const bool kFromVoxels = false;  // whether the children are voxels, whose codes are their own bounds
layout(constant_id = 3) const uint kPerThread = kDirectionsPerLevelPass;  // directions a thread, in its layer of workgroups

layout(local_size_x = kLevelThreads) in;
layout(scalar, push_constant) uniform Push { TableLevelPush push; };
// By direction, the code of the most opaque voxel; for linear8 255 minus it.
layout(scalar, binding = 0) buffer Darkest { uint maxCodePerDirection[]; };
layout(binding = 1) uniform utextureBuffer occupancy;  // an OccupancyWord a texel
#define LEVEL_STEPS_BINDING 2
#include "level_steps.glsl"
// A direction's codes and bounds, read and written. With kJoined they are read as bytes, as texels may be out of date.
#define PLANE(i)                                           \
  layout(binding = 3 + i) uniform utextureBuffer read##i; \
  layout(scalar, binding = 3 + kDirectionsPerLevelPass + i) LEVEL_ACCESS buffer Plane##i { uint8_t bytes[]; } plane##i;
#define FOR_EACH_DIRECTION(F) F(0) F(1) F(2) F(3) F(4) F(5) F(6) F(7) F(8) F(9) F(10) F(11) F(12)
FOR_EACH_DIRECTION(PLANE)

const bool kSquares = kCode == kCodeDepth8 && kFilter == kFilterGeometric;  // depths are proportional to the squares of codes
const uint kDarkest = kCode == kCodeLinear8 ? 0 : 255;

// The quantity that the filter averages. A transmittance stored as 0 counts as half the smallest code, which
// is less than the smallest code; with -infinity every mean would be -infinity.
float filtered(uint byte) {
  if (kSquares) return float(byte) * float(byte);
  const float depth = kCode == kCodeLinear8 && byte == 0 ? log(2.0 * 255.0) : decodeDepth(kCode, byte);
  return kFilter == kFilterGeometric ? depth : exp(-depth);
}
uint codeOf(float mean) {
  if (kSquares) return uint(sqrt(mean) + 0.5);
  return encodeDepth(kCode, kFilter == kFilterGeometric ? mean : -log(mean));
}
// The code of more transmittance of the two.
uint clearer(uint a, uint b) { return kCode == kCodeLinear8 ? max(a, b) : min(a, b); }
uint darkness(uint code) { return kCode == kCodeLinear8 ? 255 - code : code; }

// The ranks of the children and their numbers of voxels, 0 for those that are not occupied.
uint ranks[8];
float voxels[8];

// No children for ranks beyond the level's last block.
void findChildren(uint block) {
  const ivec3 cell = parentCell(min(block, current.parentCount - 1));
  [[unroll]] for (int row = 0; row < 4; ++row) {
    const ivec3 child = 2 * cell + ivec3(0, row & 1, row >> 1);
    const bool exists = block < current.parentCount && all(lessThan(child, current.child.dimensions));
    // Two neighbours in x are in the same word.
    const uint address = exists ? blockAddress(current.child, child) : 0;
    const uvec2 word = texelFetch(occupancy, int(address / kBlocksPerWord)).xy;
    const int bit = int(address % kBlocksPerWord);
    const ivec3 inside = extentInside(child, current.childEdge, push.voxels);
    uint rank = current.child.firstRank + rankIn(word, bit);
    [[unroll]] for (int x = 0; x < 2; ++x) {
      const bool holds = exists && (word.x >> (bit + x) & 1u) != 0;
      const int width = min(push.voxels.x - (child.x + x) * current.childEdge, current.childEdge);
      ranks[2 * row + x] = holds ? rank : current.child.firstRank;
      voxels[2 * row + x] = !holds ? 0.0 : kFromVoxels ? 1.0 : float(width) * float(inside.y) * float(inside.z);
      rank += holds ? 1 : 0;
    }
  }
}

struct Parent {
  uint code, bound, maxCodePerDirection;
};

// From the codes of the children, and the bytes that have their bounds.
Parent parentOf(uint codes[8], uint boundBytes[8]) {
  float sum = 0.0, all = 0.0;
  uint used = 0;
  Parent parent = Parent(0, kDarkest, 0);
  [[unroll]] for (int child = 0; child < 8; ++child) {
    const bool holds = voxels[child] > 0.0;
    const uint code = codes[child];
    const uint bound = kFromVoxels ? code : unpackBound(boundBytes[child], boundInByte(current.child, ranks[child]));
    sum += voxels[child] * filtered(code);
    all += voxels[child];
    used |= holds ? code : 0;
    parent.bound = holds ? clearer(parent.bound, bound) : parent.bound;
    parent.maxCodePerDirection = holds ? max(parent.maxCodePerDirection, darkness(code)) : parent.maxCodePerDirection;
  }
  if (used != 0) parent.code = codeOf(sum / all);  // it stays 0 if all children store 0
  return parent;
}

bool isWanted(uint direction) {
  return direction / kPerThread == gl_WorkGroupID.z && direction < push.directionCount;
}

// A read first avoids most atomic maxima: few codes exceed all before them. It is atomic, as other invocations write.
void takeDarkest(uint direction, uint code) {
  const uint known =
      atomicLoad(maxCodePerDirection[direction], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsRelaxed);
  if (code > known) atomicMax(maxCodePerDirection[direction], code);
}

// By direction, for a thread's blocks.
uint bounds[kDirectionsPerLevelPass];
uint deepest[kDirectionsPerLevelPass];

#define BYTE(i, place) (kJoined ? uint(plane##i.bytes[place]) : texelFetch(read##i, int(place)).x)
#define BEGIN(i) bounds[i] = deepest[i] = 0;
#define MAKE(i)                                                                                              \
  if (isWanted(i)) {                                                                                         \
    uint codes[8], boundBytes[8];                                                                            \
    [[unroll]] for (int child = 0; child < 8; ++child) {                                                     \
      codes[child] = BYTE(i, ranks[child]);                                                                  \
      boundBytes[child] = kFromVoxels ? 0 : BYTE(i, boundOf(current.child, ranks[child]));                   \
    }                                                                                                        \
    const Parent parent = parentOf(codes, boundBytes);                                                       \
    if (block < current.parentCount) plane##i.bytes[current.parent.firstRank + block] = uint8_t(parent.code); \
    bounds[i] |= packBound(kCode, parent.bound) << (4 * (block - first));                                    \
    deepest[i] = max(deepest[i], parent.maxCodePerDirection);                                                \
  }
#define END(i)                                                                                               \
  if (isWanted(i)) {                                                                                         \
    plane##i.bytes[current.parent.firstBound + first / kBoundBlocks] = uint8_t(bounds[i]);                   \
    if (kFromVoxels) takeDarkest(push.firstDirection + i, deepest[i]);                                       \
  }

uint partCount() { return (current.parentCount + kBoundBlocks - 1) / kBoundBlocks; }

void makePart(uint part) {
  const uint first = kBoundBlocks * part;
  FOR_EACH_DIRECTION(BEGIN)
  [[dont_unroll]] for (uint block = first; block < first + kBoundBlocks; ++block) {
    findChildren(block);
    FOR_EACH_DIRECTION(MAKE)
  }
  FOR_EACH_DIRECTION(END)
}

void main() { computeLevels(push.levels, kLevelThreads); }
