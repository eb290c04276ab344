// Whether the table, a plenoptic opacity function (Gao, Huang, Johnson, Moorhead 2003, "Visibility culling
// using plenoptic opacity functions"), calls a block hidden.
#ifndef TABLE_OCCLUSION_GLSL
#define TABLE_OCCLUSION_GLSL
#include "cut_frame.glsl"
#include "direction_lookup.glsl"
#include "occupancy.glsl"

layout(constant_id = 0) const int kCode = kCodeDepth8;  // of the table

vec3 toEyeFrom(ivec3 cell, int level) {
  if (frame.orthographic != 0) return -frame.ray;
  return -((vec3(cell) + 0.5) * float(1 << level) - 0.5 - frame.middle + frame.eyeToMiddle);
}

// The four table directions around a line of sight: their codes, and the depth from which on each hides.
struct BilinearCell {
  uvec2 planes[4];
  float depths[4];
};

// Finds the four directions around all lines of sight to the voxels of a block and of those beside it.
// Returns false if these lines do not share the same four.
bool findAround(vec3 toEye, int major, int level, out BilinearCell around) {
  vec3 spread = vec3(0.0);
  if (frame.orthographic == 0) {
    spread = vec3(0.5 * float((3 << level) - 1));
    spread[major] = 0.5 * float((1 << level) - 1);
  }
  const float least = abs(toEye[major]) - spread[major], largest = abs(toEye[major]) + spread[major];
  if (least <= 0.0) return false;
  // Points on a face of the cube of directions.
  const vec3 low = toEye - spread, high = toEye + spread;
  vec3 first = low / mix(vec3(largest), vec3(least), lessThan(low, vec3(0.0)));
  vec3 last = high / mix(vec3(least), vec3(largest), lessThan(high, vec3(0.0)));
  first[major] = last[major] = toEye[major] < 0.0 ? -1.0 : 1.0;
  if (any(lessThan(first, vec3(-1.0))) || any(greaterThan(last, vec3(1.0)))) return false;
  const ivec3 from = ivec3(floor(first * float(frame.cells))), to = ivec3(ceil(last * float(frame.cells)));
  if (any(greaterThan(to - from, ivec3(1)))) return false;

  // A lower bound of the length of a layer in these directions.
  const vec3 half_ = 0.5 * (last - first);
  const float layer = frame.pathLengthCorrection == 0
                          ? 1.0
                          : length(frame.indexToWorld * (first + half_)) - dot(half_, frame.axisLengths);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec3 corner = from;
    corner[(major + 1) % 3] = ((i & 1) == 0 ? from : to)[(major + 1) % 3];
    corner[(major + 2) % 3] = ((i & 2) == 0 ? from : to)[(major + 2) % 3];
    const int number = cellNumber(frame.cells, corner);
    around.planes[i] = planeAddresses[number];
    around.depths[i] = layer > 0.0 ? frame.darkDepths[number] / layer : uintBitsToFloat(0x7f800000u);
  }
  return true;
}

// Whether no voxel of an occupied block sends more than the threshold towards these directions.
bool isOpaqueTowardsEye(int level, uint rank, BilinearCell around) {
  const uint place = boundOf(frame.levels[level], rank);
  const int inByte = boundInByte(frame.levels[level], rank);
  bool dark = true;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    const uint code = unpackBound(codeAt(around.planes[i], place), inByte);
    if (decodeDepth(kCode, code) < around.depths[i]) dark = false;
    // Only code 0 is dark in linear8: from 1 to 0 the depth jumps so far that a splat next to both may shine at its rim.
    if (kCode == kCodeLinear8 && code != 0) dark = false;
  }
  return dark;
}

// The depth changes across a splat as its neighbours beside the line of sight differ, so that a bright
// neighbour brightens a part of it: the neighbours must be dark as well. All five share one set of table
// directions, because computing it costs more than the tests.
bool isHidden(ivec3 cell, int level) {
  const vec3 toEye = toEyeFrom(cell, level);
  const int major = majorAxis(toEye);
  BilinearCell around;
  if (!findAround(toEye, major, level, around)) return false;
  bool dark = true;
  [[dont_unroll]] for (int i = 0; i < 5 && dark; ++i) {
    ivec3 block = cell;
    if (i > 0) block[(major + 1 + (i & 1)) % 3] += i < 3 ? 1 : -1;
    const uint address = blockAddress(frame.levels[level], block);
    if (isInside(frame.levels[level], block) && isOccupied(address))
      dark = isOpaqueTowardsEye(level, rankAt(frame.levels[level], address), around);
  }
  return dark;
}

#endif
