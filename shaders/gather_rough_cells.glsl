// Which cells of the lattice are rough: one of their coarse samples is. Parameter: ROUGHNESS_BINDING, of the coarse samples' roughness.
#ifndef GATHER_ROUGH_CELLS_GLSL
#define GATHER_ROUGH_CELLS_GLSL
#include "gather_adaptive.glsl"

layout(binding = ROUGHNESS_BINDING) uniform textureBuffer roughness;

bool isRough(ivec2 cell) {
  const int row = coarseExtent().x;
  float largest = 0.0;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const ivec2 at = cell + ivec2(i & 1, i >> 1);
    largest = max(largest, texelFetch(roughness, at.x + at.y * row).x);
  }
  return largest > frame.sampleTolerance;
}

// Whether the cell's samples along x and along y, of which cells of the last column and row lack some, are marched.
bvec2 listsAlong(ivec2 cell) {
  if (any(greaterThanEqual(cell, coarseExtent())) || cell.y < frame.ownCells.x || cell.y >= frame.ownCells.y) return bvec2(false);
  const bvec2 inside = lessThan(cell, coarseExtent() - 1);
  return all(inside) ? bvec2(isRough(cell)) : inside;
}

// The number of the cell's samples that are marched.
uint countOfListed(ivec2 cell) {
  const bvec2 along = listsAlong(cell);
  return all(along) ? 3u : any(along) ? 1u : 0u;
}

#endif
