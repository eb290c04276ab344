// Codes of 16 bits a block, in bricks of kBrickEdge^3, x fastest.
#ifndef CODE_BRICKS_GLSL
#define CODE_BRICKS_GLSL
#include "gather_interface.h"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodeWords { uint values[]; };

// The number of the brick that has a block; blocks beyond the volume are in the empty brick.
uint codeBrick(CodeBricks bricks, ivec3 dimensions, ivec3 block) {
  if (any(lessThan(block, ivec3(0))) || any(greaterThanEqual(block, dimensions))) return 0;
  const ivec3 cell = (block + bricks.corner) >> kBrickLevels;  // lavapipe divides by powers of two slowly
  return CodeWords(bricks.numbers).values[cell.x + bricks.cells.x * (cell.y + bricks.cells.y * cell.z)];
}

// The place of a block's code.
uint codePlace(CodeBricks bricks, uint brick, ivec3 block) {
  const ivec3 local = (block + bricks.corner) & (kBrickEdge - 1);
  return ((brick << kBrickLevels | local.z) << kBrickLevels | local.y) << kBrickLevels | local.x;
}

// The word with a block's code: in the low bits if the block's position in its brick along x is even.
uint codeWord(CodeBricks bricks, uint brick, ivec3 block) { return CodeWords(bricks.codes).values[codePlace(bricks, brick, block) >> 1]; }

uint codeIn(CodeBricks bricks, uint brick, ivec3 block) {
  return bitfieldExtract(codeWord(bricks, brick, block), ((block.x + bricks.corner.x) & 1) * 16, 16);
}

// The codes of four blocks, in pairs from low to high bits; the first block's position in its brick along x is a multiple of 4.
uvec2 codePairs(CodeBricks bricks, uint brick, ivec3 first) {
  const uint word = codePlace(bricks, brick, first) >> 1;
  CodeWords words = CodeWords(bricks.codes);
  return uvec2(words.values[word], words.values[word + 1]);
}

// The code of a block, 0 without data.
uint codeAt(CodeBricks bricks, ivec3 dimensions, ivec3 block) { return codeIn(bricks, codeBrick(bricks, dimensions, block), block); }

// The scalar of a code, in intervals of the transfer function's table; kNoScalar without data.
const float kNoScalar = -1.0;
float scalarOfCode(uint code) {
  return code == 0 ? kNoScalar : (float(code) - 1.0) * (float(kTransferIntervals) / float(kScalarCodes));
}

#endif
