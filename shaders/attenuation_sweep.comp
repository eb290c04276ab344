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

layout(scalar, push_constant) uniform Push { SweepPush push; };
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
  else
    restartLines();

  for (int plane = slab.firstPlane; plane < slab.endPlane; plane += kPhases) {
    [[unroll]] for (int phase = 0; phase < kPhases; ++phase) {
      if (plane + phase >= slab.endPlane) break;
      const int row = (push.marchStart + (plane + phase) * push.marchStride + side * push.sideStride) / 4;
      const int next = wrapped(side + push.sideStep, push.lineCount);
      loadRow(row - slab.firstQuad, window, quads);
      restartWrappedLines(window, quads, phase);
      writeWindow(row, window, quads, phase);
      addRow(phase, push.stepLength);
      if (next != side + push.sideStep) restartLines();
      side = next;
    }
    window = wrapped(window + kWindowStep, quads);
  }
  if (slab.endPlane < push.marchCount) saveLineState(slab.firstDepth, thread, threads);
}
