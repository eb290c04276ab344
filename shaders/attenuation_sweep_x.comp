#version 460
// The attenuation table for the directions +x and -x: Subr et al. 2007, Section 3.1, Eq. 5. A thread sums up a row.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "stored_codes.glsl"

layout(constant_id = 1) const int kStepX = 1;  // step of the march: 1 or -1

// Whether the threads of a workgroup load and store a tile of their rows together, so that neighbouring threads access neighbouring quads.
layout(constant_id = 2) const bool kTiled = false;

const int kTileQuads = 8;
const int kTilePitch = kTileQuads + 1;  // odd, so that the quads of a column are in different banks of shared memory

layout(local_size_x = kSweepThreads) in;
layout(scalar, push_constant) uniform Push { SweepPush push; };
layout(binding = 0) uniform textureBuffer extinction;

shared vec4 tile[kTiled ? kSweepThreads * kTilePitch : 1];  // by row: extinctions, then depths

// The depths in front of the four voxels of a quad. Adds the quad's own to the row's depth.
vec4 depthsBefore(vec4 sigma, inout float depth) {
  vec4 depths;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const int c = kStepX > 0 ? i : 3 - i;
    depths[c] = depth;
    depth += sigma[c] * push.stepLength;
  }
  return depths;
}

vec4 loadQuad(int quad) { return texelFetch(extinction, quad - push.slab.firstQuad); }

void marchRow(int row, int quads) {
  float depth = 0.0;
  const int first = push.marchStart / 4 + row * quads;
  for (int i = 0; i < quads; ++i) {
    const int quad = first + (kStepX > 0 ? i : quads - 1 - i);
    storeCodes(quad, depthsBefore(loadQuad(quad), depth));
  }
}

// Where the tile has a place, counted row by row.
int slotOf(int place) { return place / kTileQuads * kTilePitch + place % kTileQuads; }

// The quad of the volume at a place of the tile, which begins at a row and a column of it; negative if there is none.
int quadAt(ivec2 begin, int quads, int place) {
  const int row = begin.x + place / kTileQuads, column = begin.y + place % kTileQuads;
  return row < push.lineCount && column >= 0 && column < quads ? push.marchStart / 4 + row * quads + column : -1;
}

void marchTiles(int firstRow, int thread, int quads) {
  float depth = 0.0;
  for (int passed = 0; passed < quads; passed += kTileQuads) {
    const ivec2 begin = ivec2(firstRow, kStepX > 0 ? passed : quads - passed - kTileQuads);
    for (int place = thread; place < kSweepThreads * kTileQuads; place += kSweepThreads) {
      const int quad = quadAt(begin, quads, place);
      tile[slotOf(place)] = quad < 0 ? vec4(0.0) : loadQuad(quad);
    }
    barrier();
    for (int i = 0; i < kTileQuads; ++i) {
      const int place = thread * kTilePitch + (kStepX > 0 ? i : kTileQuads - 1 - i);
      tile[place] = depthsBefore(tile[place], depth);
    }
    barrier();
    for (int place = thread; place < kSweepThreads * kTileQuads; place += kSweepThreads) {
      const int quad = quadAt(begin, quads, place);
      if (quad >= 0) storeCodes(quad, tile[slotOf(place)]);
    }
    barrier();
  }
}

void main() {
  const int row = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kSweepThreads);
  // Padding before the first voxel adds nothing.
  if (kTiled)
    marchTiles(row - int(gl_LocalInvocationIndex), int(gl_LocalInvocationIndex), push.rowPitch / 4);
  else if (row < push.lineCount)
    marchRow(row, push.rowPitch / 4);
}
