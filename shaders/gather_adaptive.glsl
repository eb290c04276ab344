// Adaptive sampling of the lattice (Levoy 1990, "Volume rendering by adaptive refinement"): coarse samples, which are every second one
// along both axes, are marched first; between them the others are interpolated where the coarse ones are smooth, and marched elsewhere.
// A cell is the four coarse samples (i, j) to (i + 1, j + 1), and has the three samples (2i + 1, 2j), (2i, 2j + 1) and (2i + 1, 2j + 1).
#ifndef GATHER_ADAPTIVE_GLSL
#define GATHER_ADAPTIVE_GLSL
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_frame.glsl"

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;

// Coarse samples of the lattice, whose numbers of samples are odd.
ivec2 coarseExtent() { return (frame.samples + 1) / 2; }

// Of a coarse sample, or of the nearest one in the lattice.
int placeOfCoarse(ivec2 coarse) {
  const ivec2 inside = 2 * clamp(coarse, ivec2(0), coarseExtent() - 1);
  return inside.x + inside.y * frame.samples.x;
}

#endif
