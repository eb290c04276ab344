// Adaptive sampling of the lattice (Levoy 1990, "Volume rendering by adaptive refinement"): coarse samples, which are every second one
// along both axes, are marched first; between them the others are interpolated where the coarse ones are smooth, and marched elsewhere.
// A cell is the four coarse samples (i, j) to (i + 1, j + 1), and has the three samples (2i + 1, 2j), (2i, 2j + 1) and (2i + 1, 2j + 1).
#ifndef GATHER_ADAPTIVE_GLSL
#define GATHER_ADAPTIVE_GLSL
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_frame.glsl"

layout(local_size_x = kGatherTile, local_size_y = kGatherTile) in;

// Coarse samples among those that are stored, whose numbers along both axes are odd.
ivec2 coarseExtent() { return (frame.seenExtent + 1) / 2; }

// The place in the lattice's sums of a coarse sample, or of the nearest one that is stored.
int placeOfCoarse(ivec2 coarse) { return placeOfSample(frame.firstSeen + 2 * coarse); }

#endif
