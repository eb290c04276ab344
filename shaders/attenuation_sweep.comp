#version 460
// The attenuation table for one lattice direction that is not along x: Subr et al. 2007, Section 3.1, Eq. 5.
//
// A thread marches a bundle of kVoxels lattice lines that are neighbours in x from the side at which they
// enter the volume, plane by plane, and writes each voxel's optical depth to the outside, exclusive of the
// voxel, before it adds the voxel's own. Lines that leave the box sideways enter again on the other side with
// an optical depth of 0: as many lines as the entry plane has voxels cover every voxel exactly once, and no
// face needs a case of its own.
//
// With a step in x the bundle moves by one voxel a plane while the words it writes do not. So a thread writes
// the aligned words of a window that moves by four voxels every four planes, and carries three lines more
// than it writes.
#extension GL_GOOGLE_include_directive : require
#include "interface.h"
#include "attenuation_code.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;
layout(constant_id = 1) const int kVoxels = 16;  // a multiple of 4
layout(constant_id = 2) const int kStepX = 0;    // of the march, -1, 0 or 1

layout(local_size_x = kSweepThreads) in;
layout(scalar, push_constant) uniform Push { SweepPush push; };
layout(binding = 0) uniform textureBuffer extinction;
layout(scalar, binding = 1) writeonly buffer Plane { uint words[]; };

const int kPhases = kStepX == 0 ? 1 : 4;
const int kExtraLines = kPhases - 1;
const int kWords = kVoxels / 4;
const int kMargin = kStepX == 0 ? 0 : 1;  // quads loaded on either side of the window

float depths[kVoxels + kExtraLines];                // of the lines, up to the current plane
float sigma[4 * (kWords + 2 * kMargin)];            // the current plane's, from kMargin quads before the window

int wrapped(int index, int count) { return index < 0 ? index + count : index >= count ? index - count : index; }

// At phase p the window's voxel i lies on line i + lineOffset(p).
int lineOffset(int phase) { return kStepX > 0 ? 3 - phase : kStepX < 0 ? phase : 0; }

void loadPlane(int row, int window, int quads) {
  [[unroll]] for (int q = 0; q < kWords + 2 * kMargin; ++q) {
    const vec4 quad = texelFetch(extinction, row + wrapped(window + q - kMargin, quads));
    [[unroll]] for (int c = 0; c < 4; ++c) sigma[4 * q + c] = quad[c];
  }
}

// A line that has just come around the end of the row starts again at the boundary of the volume.
void restartWrappedLines(int window, int quads, int phase) {
  if (kStepX == 0) return;
  const int entryQuad = kStepX > 0 ? 0 : quads - 1;
  [[unroll]] for (int q = -1; q <= kWords; ++q) {
    const int line = 4 * q + (kStepX > 0 ? 0 : 3) + lineOffset(phase);
    if (line >= 0 && line < kVoxels + kExtraLines && wrapped(window + q, quads) == entryQuad) depths[line] = 0.0;
  }
}

void writeWindow(int row, int window, int quads, int phase) {
  [[unroll]] for (int w = 0; w < kWords; ++w) {
    uint word = 0;
    [[unroll]] for (int c = 0; c < 4; ++c)
      word |= encodeDepth(kCode, depths[4 * w + c + lineOffset(phase)]) << (8 * c);
    words[row + wrapped(window + w, quads)] = word;
  }
}

void addPlane(int phase) {
  [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line)
    depths[line] += sigma[line - lineOffset(phase) + 4 * kMargin] * push.stepLength;
}

void main() {
  const int quads = push.rowPitch / 4;
  const int bundles = push.rowPitch / kVoxels;
  const int thread = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kSweepThreads);
  int side = push.firstLine + thread / bundles;
  if (side >= push.lastLine) return;

  [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line) depths[line] = 0.0;
  int window = thread % bundles * kWords;  // first quad of voxels that this thread writes

  for (int plane = 0; plane < push.marchCount; plane += kPhases) {
    [[unroll]] for (int phase = 0; phase < kPhases; ++phase) {
      if (plane + phase >= push.marchCount) break;
      const int row = (push.marchStart + (plane + phase) * push.marchStride + side * push.sideStride) / 4;
      loadPlane(row, window, quads);
      restartWrappedLines(window, quads, phase);
      writeWindow(row, window, quads, phase);
      addPlane(phase);

      const int next = wrapped(side + push.sideStep, push.lineCount);
      if (next != side + push.sideStep)
        [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line) depths[line] = 0.0;
      side = next;
    }
    window = wrapped(window + kStepX, quads);
  }
}
