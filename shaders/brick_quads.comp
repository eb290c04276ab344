#version 460
// What the gather reads of the blocks of a level in one fetch: of every block of a brick, and its next neighbours along the
// sides of an axis, extinction, source term and how that depends on the direction to the eye. In a brick blocks are in the
// order of the march: the axis, then the first side, then the second one.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "blocks.glsl"
#include "rank.glsl"

layout(constant_id = 0) const int kAxis = 2;
layout(constant_id = 1) const bool kTowards = false;
layout(constant_id = 2) const bool kColored = true;

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { BrickQuadsPush push; };
layout(binding = 0) uniform utextureBuffer brickCells;  // of each brick, in blocks: x, y, z of its first one
layout(binding = 1) uniform utextureBuffer occupancy;   // OccupancyWord
layout(binding = 2) uniform utextureBuffer sources;     // by rank: packed source term, extinction as a half
layout(binding = 3) uniform utextureBuffer towards;    // by rank, where kTowards says so
layout(binding = 4, rg32ui) writeonly uniform uimageBuffer extinctionQuads;
layout(binding = 5, rgba32ui) writeonly uniform uimageBuffer sourceQuads;
layout(binding = 6, rgba32ui) writeonly uniform uimageBuffer towardsQuads;

const int kSideA = kAxis == 0 ? 1 : 0;
const int kSideB = kAxis == 2 ? 1 : 2;
const int kEdgeMask = kGatherGroup - 1;

void main() {
  const uint number = gl_LocalInvocationID.x + kBrickQuadsThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (number >= push.count) return;
  const int quad = int(push.firstBrick) * kGatherBrickBlocks + int(number);
  const int inBrick = int(number);
  ivec3 first = ivec3(texelFetch(brickCells, quad >> (3 * kSkipLevels)).xyz);
  first[kAxis] += inBrick & kEdgeMask;
  first[kSideA] += inBrick >> kSkipLevels & kEdgeMask;
  first[kSideB] += inBrick >> (2 * kSkipLevels) & kEdgeMask;
  const ivec3 strides = ivec3(1, push.level.rowPitch, push.level.rowPitch * push.level.dimensions.y);
  const int firstAddress = int(blockAddress(push.level, first)), stepA = strides[kSideA], stepB = strides[kSideB];
  uvec4 extinctions;  // halves
  uvec4 packed = uvec4(0), directions = uvec4(0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec3 cell = first;
    cell[kSideA] += i & 1;
    cell[kSideB] += i >> 1;
    const bool inside = all(lessThan(cell, push.level.dimensions));
    const int address = inside ? firstAddress + (i & 1) * stepA + (i >> 1) * stepB : 0;
    const uvec2 word = texelFetch(occupancy, address >> 5).xy;
    const int bit = address & 31;
    const bool occupied = inside && (word.x >> bit & 1u) != 0;
    const int rank = occupied ? int(push.level.firstRank + rankIn(word, bit)) : 0;
    const uvec2 source = texelFetch(sources, rank).xy;
    extinctions[i] = occupied ? source.y : 0;
    if (kColored) packed[i] = occupied ? source.x : 0;
    if (kTowards) directions[i] = texelFetch(towards, rank).x;
  }
  imageStore(extinctionQuads, quad, uvec4(extinctions.x | extinctions.y << 16, extinctions.z | extinctions.w << 16, 0, 0));
  if (kColored) imageStore(sourceQuads, quad, packed);
  if (kTowards) imageStore(towardsQuads, quad, directions);
}
