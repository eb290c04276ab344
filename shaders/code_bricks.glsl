// Codes of 16 bits a block, in bricks of kBrickEdge^3, x fastest.
#ifndef CODE_BRICKS_GLSL
#define CODE_BRICKS_GLSL
#include "gather_interface.h"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CodeWords { uint values[]; };

// The code of a block, 0 without data. Blocks beyond the volume have no data.
uint codeAt(CodeBricks bricks, ivec3 dimensions, ivec3 block) {
  const ivec3 place = block + bricks.corner;
  const ivec3 cell = place >> kBrickLevels, local = place & (kBrickEdge - 1);  // lavapipe divides by powers of two slowly
  const bool inside = all(greaterThanEqual(block, ivec3(0))) && all(lessThan(block, dimensions));
  const uint brick = inside ? CodeWords(bricks.numbers).values[cell.x + bricks.cells.x * (cell.y + bricks.cells.y * cell.z)] : 0;
  const uint index = inside ? ((brick << kBrickLevels | local.z) << kBrickLevels | local.y) << kBrickLevels | local.x : 0;
  return bitfieldExtract(CodeWords(bricks.codes).values[index >> 1], int(index & 1u) * 16, 16);
}

#endif
