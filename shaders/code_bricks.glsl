// Codes of 16 bits a block, in bricks of kBrickEdge^3, x fastest. A shader that has them as texels, which lavapipe reads in less time than
// storage buffers, defines CODE_TEXELS_BINDING, the binding of the words of two codes (the brick numbers are in the next one), and CODE_TEXELS_CONSTANT.
#ifndef CODE_BRICKS_GLSL
#define CODE_BRICKS_GLSL
#include "gather_interface.h"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodeWords { uint values[]; };

#ifdef CODE_TEXELS_BINDING
#extension GL_EXT_samplerless_texture_functions : require
layout(constant_id = CODE_TEXELS_CONSTANT) const bool kCodeTexels = true;  // whether all of them are within the range of texels
layout(binding = CODE_TEXELS_BINDING) uniform utextureBuffer codeTexels;
layout(binding = CODE_TEXELS_BINDING + 1) uniform utextureBuffer codeNumberTexels;
uint codeWordAt(CodeBricks bricks, uint word) {
  return kCodeTexels ? texelFetch(codeTexels, int(word)).x : CodeWords(bricks.codes).values[word];
}
uint codeNumberAt(CodeBricks bricks, int cell) {
  return kCodeTexels ? texelFetch(codeNumberTexels, cell).x : CodeWords(bricks.numbers).values[cell];
}
#else
uint codeWordAt(CodeBricks bricks, uint word) { return CodeWords(bricks.codes).values[word]; }
uint codeNumberAt(CodeBricks bricks, int cell) { return CodeWords(bricks.numbers).values[cell]; }
#endif

// The number of the brick that has a block; blocks beyond the volume are in the empty brick.
uint codeBrick(CodeBricks bricks, ivec3 dimensions, ivec3 block) {
  if (any(lessThan(block, ivec3(0))) || any(greaterThanEqual(block, dimensions))) return 0;
  const ivec3 cell = (block + bricks.corner) >> kBrickLevels;  // lavapipe divides by powers of two slowly
  return codeNumberAt(bricks, cell.x + bricks.cells.x * (cell.y + bricks.cells.y * cell.z));
}

// The place of a block's code.
uint codePlace(CodeBricks bricks, uint brick, ivec3 block) {
  const ivec3 local = (block + bricks.corner) & (kBrickEdge - 1);
  return ((brick << kBrickLevels | local.z) << kBrickLevels | local.y) << kBrickLevels | local.x;
}

// The word with a block's code: in the low bits if the block's position in its brick along x is even.
uint codeWord(CodeBricks bricks, uint brick, ivec3 block) { return codeWordAt(bricks, codePlace(bricks, brick, block) >> 1); }

uint codeIn(CodeBricks bricks, uint brick, ivec3 block) {
  return bitfieldExtract(codeWord(bricks, brick, block), ((block.x + bricks.corner.x) & 1) * 16, 16);
}

// The codes of four blocks, in pairs from low to high bits; the first block's position in its brick along x is a multiple of 4.
uvec2 codePairs(CodeBricks bricks, uint brick, ivec3 first) {
  const uint word = codePlace(bricks, brick, first) >> 1;
  return uvec2(codeWordAt(bricks, word), codeWordAt(bricks, word + 1));
}

// The code of a block, 0 without data.
uint codeAt(CodeBricks bricks, ivec3 dimensions, ivec3 block) { return codeIn(bricks, codeBrick(bricks, dimensions, block), block); }

// The scalar of a code, in intervals of the transfer function's table; kNoScalar without data.
const float kNoScalar = -1.0;
float scalarOfCode(uint code) {
  return code == 0 ? kNoScalar : (float(code) - 1.0) * (float(kTransferIntervals) / float(kScalarCodes));
}

#endif
