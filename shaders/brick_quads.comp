#version 460
// What the gather reads of the blocks of a level in one fetch: of every block of a brick, and its next neighbours along the
// sides of an axis, extinction, source term and one more word; of voxels that are
// classified after interpolation the codes of their scalars in place of extinctions. In a brick blocks are in the order of
// the march: the axis, then the first side, then the second one.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "blocks.glsl"
#include "code_bricks.glsl"
#include "rank.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(constant_id = 0) const int kAxis = 2;
layout(constant_id = 1) const bool kExtra = false;
layout(constant_id = 2) const bool kColored = true;
layout(constant_id = 3) const bool kCodes = false;  // codes of 16 bits in place of extinctions: of scalars, or depths towards a light
layout(constant_id = 4) const bool kShaded = true;  // whether extinctions are those of shade_blocks.comp, and not those of the volume

layout(local_size_x = kBrickQuadsThreads) in;
layout(scalar, push_constant) uniform Push { BrickQuadsPush push; };
layout(binding = 0) uniform utextureBuffer brickCells;  // of each brick, in blocks: x, y, z of its first one
layout(binding = 1) uniform utextureBuffer occupancy;   // OccupancyWord
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Words { uint values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Extinctions { float values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Sources { uvec2 values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer MediumQuads { uvec2 values[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer SourceQuads { uvec4 values[]; };

const int kSideA = kAxis == 0 ? 1 : 0;
const int kSideB = kAxis == 2 ? 1 : 2;
const int kEdgeMask = kGatherBrickEdge - 1;

// What is kept of two blocks, neighbours along the second side.
struct Pair {
  uvec2 medium;  // halves of extinctions, or codes
  uvec2 source, extra;
};

// A row of quads needs two rows of blocks, neighbours along the second side. Along the first side each meets at most two bricks of codes.
struct CodeRow {
  int firstCell;    // position of the first brick along the first side
  uvec2 near, far;  // numbers of the first and the second brick, by row
};

CodeRow codeRowFrom(ivec3 cell) {
  CodeRow row;
  row.firstCell = (cell[kSideA] + push.codes.corner[kSideA]) >> kBrickLevels;
  [[unroll]] for (int i = 0; i < 2; ++i) {
    row.near[i] = codeBrick(push.codes, push.level.dimensions, cell);
    ivec3 last = cell;
    last[kSideA] = min(cell[kSideA] + kGatherBrickEdge, push.level.dimensions[kSideA] - 1);
    row.far[i] = codeBrick(push.codes, push.level.dimensions, last);
    ++cell[kSideB];
  }
  return row;
}

Pair pairAt(ivec3 first, CodeRow row) {
  Pair pair = Pair(uvec2(0), uvec2(0), uvec2(0));
  [[unroll]] for (int i = 0; i < 2; ++i) {
    ivec3 cell = first;
    cell[kSideB] += i;
    const bool inside = all(lessThan(cell, push.level.dimensions));
    if (kCodes) {
      const bool isNear = (cell[kSideA] + push.codes.corner[kSideA]) >> kBrickLevels == row.firstCell;
      pair.medium[i] = codeIn(push.codes, inside ? isNear ? row.near[i] : row.far[i] : 0, cell);
    }
    if (kCodes && !kColored) continue;
    const int address = inside ? int(blockAddress(push.level, cell)) : 0;
    const uvec2 word = texelFetch(occupancy, address >> 5).xy;
    const int bit = address & 31;
    const bool occupied = inside && (word.x >> bit & 1u) != 0;
    const uint rank = occupied ? push.level.firstRank + rankIn(word, bit) : 0;
    if (!kCodes && !kShaded) {
      const float stored = min(push.extinctionScale * Extinctions(push.sources).values[rank], kMaxStored);
      pair.medium[i] = occupied ? packHalf2x16(vec2(stored, 0.0)) : 0;
      continue;
    }
    const uvec2 source = Sources(push.sources).values[rank];
    if (!kCodes) pair.medium[i] = occupied ? source.y : 0;
    pair.source[i] = occupied ? source.x : 0;
    if (kExtra) pair.extra[i] = occupied ? Words(push.extras).values[rank] : 0;
  }
  return pair;
}

// Blocks of a row along x, from a first one to the next brick's first one, at successive addresses.
struct BlockRow {
  uint occupied;  // a bit for each block
  uint next;      // rank of the next occupied block
};

BlockRow blockRowFrom(ivec3 cell) {
  const int inside = any(greaterThanEqual(cell, push.level.dimensions)) ? 0 : min(push.level.dimensions.x - cell.x, kGatherBrickEdge + 1);
  const int address = inside > 0 ? int(blockAddress(push.level, cell)) : 0, bit = address & 31, last = address + max(inside - 1, 0);
  const uvec2 word = texelFetch(occupancy, address >> 5).xy;
  const uint beyond = bit == 0 ? 0 : texelFetch(occupancy, last >> 5).x << (32 - bit);
  return BlockRow(bitfieldExtract(word.x >> bit | beyond, 0, inside), push.level.firstRank + rankIn(word, bit));
}

uint nextExtinction(inout BlockRow row, int i) {
  const bool occupied = (row.occupied >> i & 1u) != 0;
  const float stored = push.extinctionScale * Extinctions(push.sources).values[occupied ? row.next : 0];
  row.next += occupied ? 1 : 0;
  return occupied ? packHalf2x16(vec2(min(stored, kMaxStored), 0.0)) : 0;
}

// The quads of a row along x of extinctions alone.
void storeExtinctionQuads(ivec3 cell, uint quad) {
  BlockRow rows[2];
  uvec2 medium;
  [[unroll]] for (int i = 0; i < 2; ++i) {
    rows[i] = blockRowFrom(cell);
    medium[i] = nextExtinction(rows[i], 0);
    ++cell[kSideB];
  }
  [[unroll]] for (int k = 0; k < kGatherBrickEdge; ++k) {
    uvec2 next;
    [[unroll]] for (int i = 0; i < 2; ++i) next[i] = nextExtinction(rows[i], k + 1);
    MediumQuads(push.medium).values[quad + k * kGatherBrickEdge] = medium | next << 16;
    medium = next;
  }
}

// The quads of a row along x: their rows of two codes are words, or the ends of two words.
void storeCodeQuads(ivec3 cell, CodeRow row, uint quad) {
  const int place = cell.x + push.codes.corner.x, odd = place & 1;
  uint words[2][kGatherBrickEdge / 2 + 1];
  [[unroll]] for (int i = 0; i < 2; ++i) {
    ivec3 block = cell;
    block[kSideB] += i;
    block.x -= odd;
    const bool inside = block[kSideB] < push.level.dimensions[kSideB] && block[kAxis] < push.level.dimensions[kAxis];
    [[unroll]] for (int j = 0; j <= kGatherBrickEdge / 2; ++j) {
      const bool isNear = (place - odd + 2 * j) >> kBrickLevels == row.firstCell;
      words[i][j] = codeWord(push.codes, inside ? isNear ? row.near[i] : row.far[i] : 0, block);
      block.x += 2;
    }
  }
  const int inside = push.level.dimensions.x - cell.x;  // the number of blocks that are not beyond the volume
  [[unroll]] for (int k = 0; k < kGatherBrickEdge; ++k) {
    uvec2 rows;
    [[unroll]] for (int i = 0; i < 2; ++i) {
      const uint across = words[i][k / 2] >> 16 | words[i][k / 2 + 1] << 16;
      rows[i] = (k & 1) == odd ? words[i][(k + 1) / 2] : across;
    }
    MediumQuads(push.medium).values[quad + k * kGatherBrickEdge] = rows & (k + 1 < inside ? 0xffffffffu : k < inside ? 0xffffu : 0u);
  }
}

// A workgroup a brick, a thread a row of quads along the first side.
void main() {
  const uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  if (brick >= push.count) return;
  const int slice = int(gl_LocalInvocationIndex) & kEdgeMask, row = int(gl_LocalInvocationIndex) >> kBrickLevels;
  ivec3 cell = ivec3(texelFetch(brickCells, int(push.firstBrick + brick)).xyz);
  cell[kAxis] += slice;
  cell[kSideB] += row;
  uint quad = push.firstQuad + brick * kGatherBrickBlocks + slice + (row << (2 * kBrickLevels));
  CodeRow codes;
  if (kCodes) codes = codeRowFrom(cell);
  if (kCodes && !kColored && kSideA == 0) {
    storeCodeQuads(cell, codes, quad);
    return;
  }
  if (!kCodes && !kShaded && kSideA == 0) {
    storeExtinctionQuads(cell, quad);
    return;
  }
  Pair pair = pairAt(cell, codes);
  for (int i = 0; i < kGatherBrickEdge; ++i) {
    ++cell[kSideA];
    const Pair next = pairAt(cell, codes);
    MediumQuads(push.medium).values[quad] = pair.medium | next.medium << 16;
    if (kColored) SourceQuads(push.source).values[quad] = uvec4(pair.source.x, next.source.x, pair.source.y, next.source.y);
    if (kExtra) SourceQuads(push.extra).values[quad] = uvec4(pair.extra.x, next.extra.x, pair.extra.y, next.extra.y);
    quad += kGatherBrickEdge;
    pair = next;
  }
}
