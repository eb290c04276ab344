#version 460
// The attenuation table for one of the 26 lattice directions that is not along x: Subr et al. 2007, Section
// 3.1, Eq. 5.
//
// A thread marches a bundle of lines from the side at which they enter the volume, plane by plane, and writes
// each voxel's optical depth to the outside, exclusive of the voxel, before it adds the voxel's own.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "attenuation_code.glsl"
#include "line_bundle.glsl"

layout(scalar, push_constant) uniform Push { SweepPush push; };

void main() {
  const int quads = push.rowPitch / 4;
  const int bundles = push.rowPitch / kVoxels;
  const int thread = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kSweepThreads);
  int side = push.firstLine + thread / bundles;
  if (side >= push.lastLine) return;

  restartLines();
  int window = thread % bundles * kWindowQuads;  // first quad of voxels that this thread writes

  for (int plane = 0; plane < push.marchCount; plane += kPhases) {
    [[unroll]] for (int phase = 0; phase < kPhases; ++phase) {
      if (plane + phase >= push.marchCount) break;
      const int row = (push.marchStart + (plane + phase) * push.marchStride + side * push.sideStride) / 4;
      loadRow(row, window, quads);
      restartWrappedLines(window, quads, phase);
      writeWindow(row, window, quads, phase);
      addRow(phase, push.stepLength);

      const int next = wrapped(side + push.sideStep, push.lineCount);
      if (next != side + push.sideStep) restartLines();
      side = next;
    }
    window = wrapped(window + kWindowStep, quads);
  }
}
