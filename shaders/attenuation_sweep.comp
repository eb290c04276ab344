#version 460
// The attenuation table for one of the 26 lattice directions that is not along x: Subr et al. 2007, Section
// 3.1, Eq. 5.
//
// A thread marches a bundle of lines, plane by plane, from the side at which they enter the volume. It writes
// each voxel's optical depth to the outside, without the voxel itself, and then adds the voxel's own.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "line_bundle.glsl"

layout(constant_id = 3) const bool kOfPart = false;  // whether the box is a part of a volume, with depths where lines enter it

layout(scalar, push_constant) uniform Push { SweepPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EntryDepths { float values[]; };

// Planes are counted in the order of the march.
int planeFromLowest(int plane) { return push.marchStride < 0 ? push.marchCount - 1 - plane : plane; }

// The lines' depths where they enter a part by the first plane.
void enterFirstPlane(int side, int window) {
  [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line) {
    const int x = wrapped(4 * window + line - lineOffset(0), push.rowPitch);
    const int place = push.entry.marchFace + side * push.entry.rowLength + x;
    depths[line] = x < push.entry.rowLength ? EntryDepths(push.entry.depths).values[place] : 0.0;
  }
}

// The depth of the line that enters a part by the face across x.
void enterAcrossX(int plane, int side, int window, int phase) {
  if (kSize == 0) return;
  const int x = kStepX > 0 ? 0 : push.entry.rowLength - 1;
  const int line = wrapped(x - 4 * window + lineOffset(phase), push.rowPitch);
  const int place = push.entry.rowFace + planeFromLowest(plane) * push.entry.rowFaceMarch + side * push.entry.rowFaceSide;
  const float depth = EntryDepths(push.entry.depths).values[place];
  [[unroll]] for (int i = 0; i < kVoxels + kExtraLines; ++i)
    if (i == line || i == line + push.rowPitch) depths[i] = depth;
}

// To the next plane of a part. Where the lines leave by a side, those that enter at the opposite side take their place, whose depths are
// behind the slab's extinction: an address is chosen, since a branch would cost as much as the load in every row.
void addRowOrEnter(bool leaves, int plane, int row, int window, int quads, int phase) {
  const int entering = push.entry.sideFace + planeFromLowest(min(plane + 1, push.marchCount - 1)) * quads;
  loadRow(leaves ? entering : row, window, quads);
  [[unroll]] for (int j = 0; j < 4 * kQuads; ++j)
    if (isLine(lineOf(j, phase)))
      depths[lineOf(j, phase)] = leaves ? sigma[j] : depths[lineOf(j, phase)] + sigma[j] * push.stepLength;
}

void main() {
  const int quads = push.rowPitch / 4;
  const int bundles = push.rowPitch / kVoxels;
  const int threads = push.lineCount * bundles;
  const int thread = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kSweepThreads);
  if (thread >= threads) return;
  const SweepSlab slab = push.slab;
  int side = movedBy(thread / bundles, slab.firstPlane * push.sideStep, push.lineCount);
  // The first quad of voxels that this thread writes.
  int window = movedBy(thread % bundles * kWindowQuads, slab.firstPlane / kPhases * kWindowStep, quads);
  if (slab.firstPlane > 0)
    resumeLines(slab.firstDepth, thread, threads);
  else if (kOfPart)
    enterFirstPlane(side, window);
  else
    restartLines();

  for (int plane = slab.firstPlane; plane < slab.endPlane; plane += kPhases) {
    [[unroll]] for (int phase = 0; phase < kPhases; ++phase) {
      if (plane + phase >= slab.endPlane) break;
      const int row = (push.marchStart + (plane + phase) * push.marchStride + side * push.sideStride) / 4;
      const int next = wrapped(side + push.sideStep, push.lineCount);
      const bool leaves = next != side + push.sideStep;
      if (kOfPart) {
        enterAcrossX(plane + phase, side, window, phase);
        writeWindow(row, window, quads, phase);
        addRowOrEnter(leaves, plane + phase, row - slab.firstQuad, window, quads, phase);
      } else {
        loadRow(row - slab.firstQuad, window, quads);
        restartWrappedLines(window, quads, phase);
        writeWindow(row, window, quads, phase);
        addRow(phase, push.stepLength);
        if (leaves) restartLines();
      }
      side = next;
    }
    window = wrapped(window + kWindowStep, quads);
  }
  if (slab.endPlane < push.marchCount) saveLineState(slab.firstDepth, thread, threads);
}
