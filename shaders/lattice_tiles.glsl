// The tiles of a lattice.
#ifndef LATTICE_TILES_GLSL
#define LATTICE_TILES_GLSL
#include "gather_frame.glsl"

// Their numbers along both axes.
ivec2 tilesOfLattice() { return (frame.seenExtent + kLatticeTile - 1) / kLatticeTile; }

// The first sample of a tile, of those of the whole lattice.
ivec2 firstOfTile(int tile) {
  const int columns = tilesOfLattice().x;
  return frame.firstSeen + ivec2(tile % columns, tile / columns) * kLatticeTile;
}

#endif
