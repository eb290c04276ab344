// Whether a block is hidden as far as the table knows, which is a plenoptic opacity function (Gao, Huang, Johnson, Moorhead
// 2003, "Visibility culling using plenoptic opacity functions"). Include after occupancy.glsl, attenuation_code.glsl,
// major_axis.glsl and direction_lookup.glsl; `frame` is the CutFrame, kCode the table's.

vec3 toEyeFrom(ivec3 cell, int level) {
  if (frame.orthographic != 0) return -frame.ray;
  return -((vec3(cell) + 0.5) * float(1 << level) - 0.5 - frame.middle + frame.eyeToMiddle);
}

// Whether all voxels of a block that holds anything are dark in the four directions around the line of sight to each of
// them. No where they have not the same four.
bool isDark(ivec3 cell, int level) {
  const vec3 toEye = toEyeFrom(cell, level);
  const float spread = frame.orthographic == 0 ? 0.5 * float((1 << level) - 1) : 0.0;
  const int major = majorAxis(toEye);
  const float least = abs(toEye[major]) - spread, largest = abs(toEye[major]) + spread;
  if (least <= 0.0) return false;
  // Points on the face of the cube of directions.
  const vec3 low = toEye - spread, high = toEye + spread;
  vec3 first = low / mix(vec3(largest), vec3(least), lessThan(low, vec3(0.0)));
  vec3 last = high / mix(vec3(least), vec3(largest), lessThan(high, vec3(0.0)));
  first[major] = last[major] = toEye[major] < 0.0 ? -1.0 : 1.0;
  if (any(lessThan(first, vec3(-1.0))) || any(greaterThan(last, vec3(1.0)))) return false;
  const ivec3 from = ivec3(floor(first * float(frame.cells))), to = ivec3(ceil(last * float(frame.cells)));
  if (any(greaterThan(to - from, ivec3(1)))) return false;

  // No layer in these directions is shorter.
  const vec3 around = 0.5 * (last - first);
  const float layer = frame.pathLengthCorrection == 0 ? 1.0
                                                      : length(frame.indexToWorld * (first + around)) -
                                                            dot(around, frame.axisLengths);
  const uint rank = rankAt(frame.levels[level], blockAddress(frame.levels[level], cell));
  const uint bound = rank + (level > 0 ? frame.boundsOffset : 0);
  const int a = (major + 1) % 3, b = (major + 2) % 3;
  ivec3 corner = from;
  for (int i = 0; i < 4; ++i) {
    corner[a] = (i & 1) == 0 ? from[a] : to[a];
    corner[b] = (i & 2) == 0 ? from[b] : to[b];
    const int number = cellNumber(frame.cells, corner);
    const uint word = CodePlane(PLANE_ADDRESS(number)).words[bound / 4];
    const uint code = bitfieldExtract(word, int(bound & 3) * 8, 8);
    if (decodeDepth(kCode, code) * layer < frame.darkDepths[number]) return false;
    // Between 0 and 1 depths jump so much that a splat next to both may shine at its rim.
    if (kCode == kCodeLinear8 && code != 0) return false;
  }
  return true;
}

// A splat's depth changes across it as those of its neighbours beside the line of sight differ, and where one of them is
// bright some of it is: they have to be dark as well.
bool isHidden(ivec3 cell, int level) {
  const int major = majorAxis(toEyeFrom(cell, level));
  bool dark = true;
  [[dont_unroll]] for (int i = 0; i < 5 && dark; ++i) {
    ivec3 neighbour = cell;
    if (i > 0) neighbour[(major + 1 + (i & 1)) % 3] += i < 3 ? 1 : -1;
    if (isInside(frame.levels[level], neighbour) && holdsAnything(blockAddress(frame.levels[level], neighbour)))
      dark = isDark(neighbour, level);
  }
  return dark;
}
