// Shared by the sweeps that march along z or y: a bundle of lattice lines that are neighbours in x, carried
// by one thread.
//
// Lines that leave the box at a side enter it again at the opposite side with an optical depth of 0: as many
// lines as the entry plane has voxels cover every voxel exactly once, and no face is a special case.
//
// With a step in x the bundle moves along the rows plane by plane, while a thread must write aligned quads of
// voxels. It therefore writes the quads of a window that moves by one quad every kPhases planes, and carries
// kExtraLines lines more than it writes.
//
// If a volume is swept slab by slab, every thread stores the depths of all its lines between slabs.
#ifndef LINE_BUNDLE_GLSL
#define LINE_BUNDLE_GLSL
#include "stored_codes.glsl"

layout(constant_id = 1) const int kVoxels = 16;  // a multiple of 4
layout(constant_id = 2) const int kStepX = 0;    // of the march, -2 to 2

layout(local_size_x = kSweepThreads) in;
layout(binding = 0) uniform textureBuffer extinction;
layout(scalar, binding = 3) buffer KeptDepths { float carriedDepths[]; };

const int kSize = kStepX < 0 ? -kStepX : kStepX;
const int kPhases = kSize == 0 ? 1 : kSize == 1 ? 4 : 2;
const int kExtraLines = kSize * (kPhases - 1);
const int kWindowQuads = kVoxels / 4;
const int kMargin = kSize == 0 ? 0 : 1;         // quads read on both sides of the window
const int kQuads = kWindowQuads + 2 * kMargin;
const int kWindowStep = kStepX < 0 ? -1 : kStepX > 0 ? 1 : 0;  // quads, every kPhases planes

float depths[kVoxels + kExtraLines];  // optical depths of the lines up to the current plane
float sigma[4 * kQuads];              // extinction of a row, starting kMargin quads before the window

int wrapped(int index, int count) { return index < 0 ? index + count : index >= count ? index - count : index; }

// At phase p the window's voxel i lies on line i + lineOffset(p), and sigma[j] on line lineOf(j, p).
int lineOffset(int phase) { return kStepX > 0 ? kExtraLines - kSize * phase : kSize * phase; }
int lineOf(int j, int phase) { return j - 4 * kMargin + lineOffset(phase); }
bool isLine(int line) { return line >= 0 && line < kVoxels + kExtraLines; }

// Whether the march enters the rows in this quad of the window.
bool isEntry(int quad, int window, int quads) { return wrapped(window + quad, quads) == (kStepX > 0 ? 0 : quads - 1); }

void restartLines() {
  [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line) depths[line] = 0.0;
}

void saveLineState(uint first, uint thread, uint threads) {
  [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line)
    carriedDepths[first + uint(line) * threads + thread] = depths[line];
}

void resumeLines(uint first, uint thread, uint threads) {
  [[unroll]] for (int line = 0; line < kVoxels + kExtraLines; ++line)
    depths[line] = carriedDepths[first + uint(line) * threads + thread];
}

// The index after a number of steps with wrapping. (The remainder of negative numbers is undefined in GLSL.)
int movedBy(int index, int steps, int count) {
  const int by = abs(steps) % count;
  return wrapped(steps < 0 ? index - by : index + by, count);
}

// Lines that have just wrapped around the end of the row start again at the boundary of the volume.
void restartWrappedLines(int window, int quads, int phase) {
  if (kSize == 0) return;
  [[unroll]] for (int q = -1; q <= kWindowQuads; ++q)
    [[unroll]] for (int i = 0; i < kSize; ++i) {
      const int line = 4 * q + (kStepX > 0 ? i : 3 - i) + lineOffset(phase);
      if (isLine(line) && isEntry(q, window, quads)) depths[line] = 0.0;
    }
}

// `row` is its first quad, counted from the slab's first.
vec4 loadQuad(int row, int q, int window, int quads) {
  return texelFetch(extinction, row + wrapped(window + q - kMargin, quads));
}

void loadRow(int row, int window, int quads) {
  [[unroll]] for (int q = 0; q < kQuads; ++q) {
    const vec4 quad = loadQuad(row, q, window, quads);
    [[unroll]] for (int c = 0; c < 4; ++c) sigma[4 * q + c] = quad[c];
  }
}

void addRow(int phase, float stepLength) {
  [[unroll]] for (int j = 0; j < 4 * kQuads; ++j)
    if (isLine(lineOf(j, phase))) depths[lineOf(j, phase)] += sigma[j] * stepLength;
}

void writeWindow(int row, int window, int quads, int phase) {
  [[unroll]] for (int w = 0; w < kWindowQuads; ++w) {
    const int line = 4 * w + lineOffset(phase);
    storeCodes(row + wrapped(window + w, quads), vec4(depths[line], depths[line + 1], depths[line + 2], depths[line + 3]));
  }
}

#endif
