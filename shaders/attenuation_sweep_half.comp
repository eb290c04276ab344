#version 460
// The attenuation table for one of the 72 directions half-way between those of Subr et al. 2007, Section 3.1:
// Eq. 5 along lattice lines with steps of two layers, such as (2,1,0) or (2,2,1).
//
// Like attenuation_sweep.comp, except for the layer in the middle of a step, which the line crosses between
// voxels: its extinction is the mean of the two or four voxels around the line, and it counts even if the
// voxel at the step's end is outside. A march by two planes a step has two families of lines, over even and
// over odd planes.
#extension GL_GOOGLE_include_directive : require
#include "line_bundle.glsl"

layout(constant_id = 3) const int kHalfwayRows = 1;  // number of rows around the middle of a step: 1, 2 or 4

layout(scalar, push_constant) uniform Push { HalfSweepPush push; };

bool outside(int index, int count) { return index < 0 || index >= count; }

int rowOf(int plane, int side) { return (push.start + plane * push.marchStride + side * push.sideStride) / 4; }

// The mean of the rows around the middle of the step; 0 beyond the volume.
void loadHalfwayRows(int plane, int side, int window, int quads) {
  [[unroll]] for (int j = 0; j < 4 * kQuads; ++j) sigma[j] = 0.0;
  [[unroll]] for (int i = 0; i < kHalfwayRows; ++i) {
    const ivec2 place = ivec2(plane, side) + push.halfway[i];
    const ivec2 inside = clamp(place, ivec2(0), ivec2(push.marchCount, push.sideCount) - 1);
    const float share = place == inside ? 1.0 / kHalfwayRows : 0.0;
    [[unroll]] for (int q = 0; q < kQuads; ++q) {
      const vec4 quad = share * loadQuad(rowOf(inside.x, inside.y) - push.slab.firstQuad, q, window, quads);
      [[unroll]] for (int c = 0; c < 4; ++c) sigma[4 * q + c] += quad[c];
    }
  }
}

// The rows' mean half a step back along the march; 0 beyond the row.
float halfway(int j, int window, int quads) {
  if (kSize == 0) return sigma[j];
  const bool entry = j % 4 == (kStepX > 0 ? 0 : 3) && isEntry(j / 4 - kMargin, window, quads);
  const float neighbour = entry ? 0.0 : sigma[j - kWindowStep];
  return kSize == 2 ? neighbour : 0.5 * (sigma[j] + neighbour);
}

void addHalfwayRows(int window, int quads, int phase, float stepLength) {
  [[unroll]] for (int j = 0; j < 4 * kQuads; ++j)
    if (isLine(lineOf(j, phase))) depths[lineOf(j, phase)] += halfway(j, window, quads) * stepLength;
}

void main() {
  const int quads = push.rowPitch / 4;
  const int bundles = push.rowPitch / kVoxels;
  const int families = abs(push.marchStep);
  const int threads = push.sideCount * families * bundles;
  const int thread = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * kSweepThreads);
  if (thread >= threads) return;
  const SweepSlab slab = push.slab;
  const int line = thread / bundles;
  const int family = line / push.sideCount, steps = slab.firstPlane / families;
  int side = movedBy(line - family * push.sideCount, steps * push.sideStep, push.sideCount);
  // The first quad of voxels that this thread writes.
  int window = movedBy(thread % bundles * kWindowQuads, steps / kPhases * kWindowStep, quads);
  if (slab.firstPlane == 0)
    restartLines();
  else
    resumeLines(slab.firstDepth, thread, threads);

  // Planes are counted in the order of the march: from the other end of the volume if the step is downwards.
  for (int ahead = slab.firstPlane + family; ahead < slab.endPlane;) {
    [[unroll]] for (int phase = 0; phase < kPhases; ++phase) {
      if (ahead >= slab.endPlane) break;
      const int plane = push.marchStep > 0 ? ahead : push.marchCount - 1 - ahead;
      const int row = rowOf(plane, side);
      restartWrappedLines(window, quads, phase);
      loadHalfwayRows(plane, side, window, quads);
      addHalfwayRows(window, quads, phase, push.stepLength);
      writeWindow(row, window, quads, phase);
      loadRow(row - slab.firstQuad, window, quads);
      addRow(phase, push.stepLength);

      ahead += families;
      side += push.sideStep;
      if (outside(side, push.sideCount)) {
        restartLines();
        side = (side + 2 * push.sideCount) % push.sideCount;
      }
    }
    window = wrapped(window + kWindowStep, quads);
  }
  if (slab.endPlane < push.marchCount) saveLineState(slab.firstDepth, thread, threads);
}
