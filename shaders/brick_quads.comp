#version 460
// What the gather reads of the blocks of a level in one fetch: of every block of a brick, and its next neighbours along the
// sides of an axis, extinction, source term and how that depends on the direction to the eye; of voxels that are
// classified after interpolation the codes of their scalars in place of extinctions. In a brick blocks are in the order of
// the march: the axis, then the first side, then the second one.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "blocks.glsl"
#include "rank.glsl"

layout(constant_id = 0) const int kAxis = 2;
layout(constant_id = 1) const bool kTowards = false;
layout(constant_id = 2) const bool kColored = true;
layout(constant_id = 3) const bool kScalars = false;  // codes of scalars in place of extinctions

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { BrickQuadsPush push; };
layout(binding = 0) uniform utextureBuffer brickCells;  // of each brick, in blocks: x, y, z of its first one
layout(binding = 1) uniform utextureBuffer occupancy;   // OccupancyWord
layout(binding = 2) uniform utextureBuffer sources;     // by rank: packed source term, extinction as a half
layout(binding = 3) uniform utextureBuffer towards;    // by rank, where kTowards says so
layout(binding = 7) uniform utextureBuffer scalarBricks;  // numbers, by cell
layout(binding = 8) uniform utextureBuffer scalarCodes;   // in bricks
layout(binding = 4, rg32ui) writeonly uniform uimageBuffer extinctionQuads;
layout(binding = 5, rgba32ui) writeonly uniform uimageBuffer sourceQuads;
layout(binding = 6, rgba32ui) writeonly uniform uimageBuffer towardsQuads;

const int kSideA = kAxis == 0 ? 1 : 0;
const int kSideB = kAxis == 2 ? 1 : 2;
const int kEdgeMask = kGatherBrickEdge - 1;

// 0 beyond the volume, and of voxels without data.
uint codeAt(ivec3 voxel) {
  const ivec3 place = voxel + push.corner;
  const ivec3 cell = place / kBrickEdge, local = place % kBrickEdge;
  const bool inside = all(lessThan(voxel, push.level.dimensions));
  const int brick = inside ? int(texelFetch(scalarBricks, cell.x + push.cells.x * (cell.y + push.cells.y * cell.z)).x) : 0;
  return texelFetch(scalarCodes, ((brick * kBrickEdge + local.z) * kBrickEdge + local.y) * kBrickEdge + local.x).x;
}

void main() {
  const uint number = gl_LocalInvocationID.x + kBrickQuadsThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (number >= push.count) return;
  const int quad = int(push.firstBrick) * kGatherBrickBlocks + int(number);
  const int inBrick = int(number);
  ivec3 first = ivec3(texelFetch(brickCells, quad >> (3 * kBrickLevels)).xyz);
  first[kAxis] += inBrick & kEdgeMask;
  first[kSideA] += inBrick >> kBrickLevels & kEdgeMask;
  first[kSideB] += inBrick >> (2 * kBrickLevels) & kEdgeMask;
  const ivec3 strides = ivec3(1, push.level.rowPitch, push.level.rowPitch * push.level.dimensions.y);
  const int firstAddress = int(blockAddress(push.level, first)), stepA = strides[kSideA], stepB = strides[kSideB];
  uvec4 extinctions;  // halves, or codes
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
    extinctions[i] = kScalars ? codeAt(cell) : occupied ? source.y : 0;
    if (kColored) packed[i] = occupied ? source.x : 0;
    if (kTowards) directions[i] = texelFetch(towards, rank).x;
  }
  imageStore(extinctionQuads, quad, uvec4(extinctions.x | extinctions.y << 16, extinctions.z | extinctions.w << 16, 0, 0));
  if (kColored) imageStore(sourceQuads, quad, packed);
  if (kTowards) imageStore(towardsQuads, quad, directions);
}
