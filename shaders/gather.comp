#version 460
// Each thread marches the ray of one sample of the image's lattice. The ray steps from slice to slice along its major index axis, the one
// along which it crosses the most slices. On each slice it interpolates the four nearest blocks bilinearly, and adds the light that they
// send to the eye times the transmittance of what the ray has passed: Subr et al. 2007, Section 2.1, Eq. 3 and 4, with the transmittance of
// the ray itself instead of the attenuation table.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#define TRANSFER_TABLE_BINDING 7
#include "gather_projection.glsl"

// The number of groups of ray.group slices, starting at `slice` in the ray's direction, that are empty; 0 if
// the first may not be.
int emptyGroups(LevelGeometry level, Ray ray, int slice) {
  const float first = float(slice), last = float(slice) + ray.direction * float(ray.group - 1);
  const vec2 low = min(ray.origin + ray.slope * first, ray.origin + ray.slope * last);
  ivec3 place = ivec3(floor(vec3(low, min(first, last))));
  if (kCube) place -= level.first;
  const ivec3 cell = clamp(place >> kSkipLevels, ivec3(0), level.lastSkip);
  return int(texelFetch(skipCells, level.firstSkip + cell.x * level.skipStrides.x + cell.y * level.skipStrides.y +
                                       cell.z * level.skipStrides.z).x);
}

// Rays more parallel to a side than this move by this much a slice, so that nothing is divided by 0.
const float kMinSlope = 1e-7;

// The part of `range` in which a ray is between `low` and `high` on a side.
vec2 clipped(vec2 range, float origin, float slope, float low, float high) {
  if (abs(slope) < kMinSlope) slope = kMinSlope;
  const float a = (low - origin) / slope, b = (high - origin) / slope;
  return vec2(max(range.x, min(a, b)), min(range.y, max(a, b)));
}

// The slices of the level between which a ray is in the part of the volume that is drawn, with kClips.
vec2 drawnRange(Ray ray) {
  const vec3 low = (frame.clipLow + 0.5) / ray.edge - 0.5, high = (frame.clipHigh + 0.5) / ray.edge - 0.5;
  vec2 range = vec2(low[kAxis], high[kAxis]);
  range = clipped(range, ray.origin.x, ray.slope.x, low[kSideA], high[kSideA]);
  range = clipped(range, ray.origin.y, ray.slope.y, low[kSideB], high[kSideB]);
  const float first = dot(frame.clipNormal, voxelPosition(ray, 0.0));
  const float change = dot(frame.clipNormal, voxelPosition(ray, 1.0)) - first;
  return clipped(range, first, change, -1e9, frame.clipDistance);
}

// The slices `slices.x` to `slices.y` - 1 that the ray meets inside the volume, in front of the eye and of the ray's end.
ivec2 slicesOnRay(LevelGeometry level, Ray ray, ivec2 slices) {
  vec2 range = vec2(slices) - vec2(0.0, 1.0);
  if (kClips) {
    const vec2 drawn = drawnRange(ray);
    if (drawn.x >= drawn.y) return ivec2(0, -1);
    // The stretch that begins at the last slice reaches half a slice further on average.
    range = ray.direction > 0.0 ? vec2(range.x, min(range.y, floor(drawn.y))) : vec2(max(range.x, ceil(drawn.x)), range.y);
  }
  [[unroll]] for (int side = 0; side < 2; ++side)
    range = clipped(range, ray.origin[side], ray.slope[side], -1.0, float(level.dimensions[side]));
  if (ray.direction > 0.0)
    range.x = max(range.x, ray.eye - 1.0);
  else
    range.y = min(range.y, ray.eye + 1.0);
  if (kHoldout) {
    if (ray.direction > 0.0)
      range.y = min(range.y, ray.eye + ray.reach + 1.0);
    else
      range.x = max(range.x, ray.eye - ray.reach - 1.0);
  }
  // Clamped before the conversion to int, whose range rays nearly parallel to a side exceed.
  range = clamp(range, vec2(slices.x - 1), vec2(slices.y + 1));
  return ivec2(max(int(floor(range.x)), slices.x), min(int(ceil(range.y)), slices.y - 1));
}

// With kCube: the slices, of which the first and the last may be too many, on which the ray is in the cube.
ivec2 slicesInCube(LevelGeometry level, Ray ray) {
  vec2 range = vec2(level.begin.z, level.end.z - 1);
  // The first cube of the volume has the positions up to a voxel before it, too.
  [[unroll]] for (int side = 0; side < 2; ++side)
    range = clipped(range, ray.origin[side], ray.slope[side], float(level.begin[side]) - 1.0, float(level.end[side]));
  range = clamp(range, vec2(level.begin.z - 2), vec2(level.end.z + 2));
  return ivec2(floor(range.x), ceil(range.y));
}

SliceValues sliceValuesAt(LevelGeometry level, Ray ray, int slice, bool scalars) {
  if (kScalars) {
    if (scalars) return scalarValuesAt(level, ray.origin + ray.slope * float(slice), slice, ray.toEye);
  }
  return blockValuesAt(level, ray, slice, true);
}

// Moves on to the next stretch whose scalars add something, or until `slicesLeft` is `leftAfterGroup`, and adds it; where light is not
// evaluated at samples by one stretch. The search is a loop of its own, so that stretches that add nothing are not lit: lavapipe executes a
// branch even if no lane takes it.
void addNextScalars(inout Sums sums, inout SliceValues last, inout int slice, inout int slicesLeft, LevelGeometry level, Ray ray,
                    int leftAfterGroup, int final) {
  Stretch stretch;
  int stop = leftAfterGroup;
  do {
    if (!kSampled || slicesLeft > stop) {
      stretch = scalarStretch(last, level, ray, slice, slice != final + int(ray.direction));
      slice += int(ray.direction);
      --slicesLeft;
      if (stretch.adds)
        stop = slicesLeft;
      else if (slicesLeft > stop)
        last = stretch.end;
    }
  } while (kSampled && slicesLeft > stop);
  if (stretch.adds)
    addScalarStretch(sums, last, stretch, level, ray);
  else
    last = stretch.end;
}

// Adds a slice of blocks, or the stretch up to it.
void addBlocks(inout Sums sums, inout SliceValues last, LevelGeometry level, Ray ray, int slice, bool within) {
  if (kSampled || kMerged || kHoldout)
    addBlockStretch(sums, last, level, ray, slice, within);
  else
    addSlice(sums, level, ray, slice);
}

// Branches on constants are nested, so that the compiler removes them.
void addNext(inout Sums sums, inout SliceValues last, inout int slice, inout int slicesLeft, LevelGeometry level, Ray ray,
             int leftAfterGroup, int final, bool scalars) {
  if (kScalars && !kProjected) {
    if (scalars) {
      addNextScalars(sums, last, slice, slicesLeft, level, ray, leftAfterGroup, final);
      return;
    }
  }
  if (kProjected)
    addProjected(sums, last, level, ray, slice, slice != final + int(ray.direction));
  else
    addBlocks(sums, last, level, ray, slice, slice != final + int(ray.direction));
  slice += int(ray.direction);
  --slicesLeft;
}

// Alternates between two steps until no slice is left or the ray is opaque: (1) skips groups of slices that hold nothing; (2) marches one
// group. A stretch lies between two slices, so that step 1 goes back by one where the stretch into the first occupied slice may add
// something, and one slice more is marched, which ends the last stretch.
void march(inout Sums sums, LevelGeometry level, Ray ray, ivec2 slices, float endTransmittance, bool scalars) {
  const int direction = int(ray.direction);
  const int final = direction > 0 ? slices.y : slices.x;
  int slice = direction > 0 ? slices.x : slices.y;
  int slicesLeft = slices.y - slices.x + 1;
  if (slicesLeft <= 0) return;
  const int begin = slice;
  const bool stretches = scalars || kSampled || kMerged || kHoldout;
  if (stretches) ++slicesLeft;
  SliceValues last = emptySliceValues();
  if (kCube) {
    const ivec2 slicesOfCube = slicesInCube(level, ray);
    const int before = max(direction > 0 ? slicesOfCube.x - slice : slice - slicesOfCube.y, 0);
    slice += direction * before;
    // And the slice that ends the last stretch.
    slicesLeft = min(slicesLeft - before, (direction > 0 ? slicesOfCube.y - slice : slice - slicesOfCube.x) + 2);
    if (slicesLeft <= 0) return;
    if (stretches && slice != begin) last = sliceValuesAt(level, ray, slice - direction, scalars);
  }
  do {
    if (slicesLeft > 0) {
      const int leftAtGroup = slicesLeft;
      int leftAtLastTest = slicesLeft + 1;
      do {
        if (slicesLeft > 0 && slicesLeft < leftAtLastTest) {
          leftAtLastTest = slicesLeft;
          // A stretch from the slice before may add something, so that this one has to be empty, too.
          const int before = slicesLeft == leftAtGroup && last.coverage > 0.0 ? 1 : 0;
          slicesLeft -= max(emptyGroups(level, ray, slice + direction * (leftAtGroup - slicesLeft - before)) * ray.group - before, 0);
        }
      } while (slicesLeft > 0 && slicesLeft < leftAtLastTest);
      slice += direction * (leftAtGroup - slicesLeft);
      const bool skipped = slicesLeft < leftAtGroup;
      if (skipped) last = emptySliceValues();
      // The stretch from the last slice that was skipped may add something.
      if (skipped && stretches && slicesLeft > 0) {
        slice -= direction;
        ++slicesLeft;
      }
      const int leftAfterGroup = slicesLeft - min(slicesLeft, ray.group);
      do {
        if (slicesLeft > leftAfterGroup) addNext(sums, last, slice, slicesLeft, level, ray, leftAfterGroup, final, scalars);
      } while (slicesLeft > leftAfterGroup);
      if (sums.transmittance <= endTransmittance || (kMerged && mergedTransmittance <= endTransmittance)) slicesLeft = 0;
    }
  } while (slicesLeft > 0);
}

LevelGeometry geometryOf(int levelIndex) {
  const GatherLevel level = frame.levels[levelIndex];
  LevelGeometry geometry;
  geometry.dimensions = ivec2(level.dimensions[kSideA], level.dimensions[kSideB]);
  geometry.count = level.dimensions[kAxis];
  geometry.firstCell = level.firstCell;
  const ivec3 cellStrides = ivec3(1, level.cellStrides), skipStrides = ivec3(1, level.skipStrides);
  geometry.cellStrides = ivec3(cellStrides[kSideA], cellStrides[kSideB], cellStrides[kAxis]);
  geometry.firstSkip = level.firstSkip;
  geometry.skipStrides = ivec3(skipStrides[kSideA], skipStrides[kSideB], skipStrides[kAxis]);
  geometry.lastSkip = ivec3(level.lastSkip[kSideA], level.lastSkip[kSideB], level.lastSkip[kAxis]);
  if (kCube) {
    const GatherCube cube = frame.cube;
    geometry.first = ivec3(cube.first[kSideA], cube.first[kSideB], cube.first[kAxis]);
    geometry.begin = ivec3(cube.begin[kSideA], cube.begin[kSideB], cube.begin[kAxis]);
    geometry.end = ivec3(cube.end[kSideA], cube.end[kSideB], cube.end[kAxis]);
  }
  return geometry;
}

// The ray of a sample, the same for all levels, in voxels.
struct SampleRay {
  vec3 world;    // direction in world space
  float along;   // component along the axis
  vec2 slope;    // on the sides, for each slice
  vec2 middle;   // position on the sides, on the volume's middle plane
  float eye;     // start of the ray, in slices
  float end;     // with kHoldout: distance from the eye plane at which the ray ends, world units
};

// The distance from the eye plane at which the rays of a sample's pixel end.
float holdoutAt(ivec2 index) {
  const ivec2 pixel = clamp((index - kLatticeMargin) / max(frame.raysOfPixel, 1), ivec2(0), frame.size - 1);
  return Holdout(frame.holdout).distances[pixel.x + pixel.y * frame.size.x];
}

// Adds a level of the volume to the sums, and what it adds to the distance to `distanceSum`.
void marchLevel(inout Sums sums, inout float distanceSum, SampleRay sampleRay, int levelIndex, bool scalars) {
  // In blocks of the level, the centre of whose first is at half an edge minus half a voxel.
  const float edge = float(1 << levelIndex);
  const LevelGeometry level = geometryOf(levelIndex);
  Ray ray;
  ray.origin = (sampleRay.middle + sampleRay.slope * (0.5 * edge - 0.5 - frame.axes[kAxis].middlePlane) + 0.5) / edge - 0.5;
  ray.slope = sampleRay.slope;
  ray.direction = sampleRay.along > 0.0 ? 1.0 : -1.0;
  ray.group = max(abs(sampleRay.slope.x), abs(sampleRay.slope.y)) > 1.0 ? kObliqueGroup : kSkipGroup;
  ray.eye = (sampleRay.eye + 0.5) / edge - 0.5;
  ray.layer = length(sampleRay.world) / abs(sampleRay.along) * edge * frame.extinctionUnit;
  ray.toEye = -normalize(sampleRay.world);
  ray.edge = edge;
  ray.perSlice = edge / abs(sampleRay.along);
  ray.reach = kHoldout ? min(sampleRay.end / ray.perSlice, 1e9) : 0.0;
  float ahead = 0.0;  // slices from the eye to where the ray begins
  if (kClips) {
    const vec2 drawn = drawnRange(ray);
    ahead = max(ray.direction * ((ray.direction > 0.0 ? drawn.x : drawn.y) - ray.eye), 0.0);
    ray.eye += ray.direction * ahead;
    if (kHoldout) ray.reach -= ahead;
  }
  const ivec2 slices = slicesOnRay(level, ray, frame.axes[kAxis].slices[sampleRay.along > 0.0 ? 1 : 0][levelIndex]);
  sums.distance = 0.0;
  const float before = sums.transmittance;
  if (sums.transmittance > frame.endTransmittance) march(sums, level, ray, slices, frame.endTransmittance, scalars);
  if (kClips && !kProjected) sums.distance += ahead * (before - sums.transmittance);
  if (kClips && kProjected) sums.distance += ahead * (frame.projection == kMaxIntensity ? float(sums.color.x > 0.0) : sums.color.z);
  distanceSum += ray.perSlice * sums.distance;
}

// Stores the sums of a sample. A ray that ended early becomes opaque: what lies behind its end is taken to have the mean colour of what lies
// in front.
void storeSums(int sampleIndex, vec3 color, float transmittance, float distanceSum) {
  const float energy = 1.0 - transmittance;
  const bool complete = !kCube || frame.cube.isLast != 0;
  const float whole = transmittance > frame.endTransmittance || !complete ? 1.0 : 1.0 / energy;
  imageStore(colorEnergy, sampleIndex, whole * vec4(color, energy));
  imageStore(distances, sampleIndex, vec4(whole * distanceSum));
}

// Stores the sums of a sample whose scalars are projected: between cubes what was projected so far.
void storeProjected(int sampleIndex, Projected all) {
#ifdef CONTINUES_SUMS
  const vec3 before = imageLoad(colorEnergy, sampleIndex).rgb;
  joinProjected(all, Projected(before.x, before.y, before.z, imageLoad(distances, sampleIndex).x));
  if (frame.cube.isLast == 0) {
    imageStore(colorEnergy, sampleIndex, vec4(all.largest, all.sum, all.coverage, 0.0));
    imageStore(distances, sampleIndex, vec4(all.distance));
    return;
  }
#endif
  float distance;
  imageStore(colorEnergy, sampleIndex, colorOf(all, distance));
  imageStore(distances, sampleIndex, vec4(distance));
}

void main() {
  ivec2 index = sampleOfThread();
  if (any(greaterThanEqual(index, kCube ? frame.cube.extent : frame.seenExtent))) return;
  if (!kCube && push.rays != uvec2(0)) {
    // With other volumes: rays that meet only this one are marched as if there were no others.
    const uint met = MergedRays(push.rays).values[slotOfThread()], own = 1u << push.volume;
    const bool isLast = met >> push.volume == 1u;
    if ((met & own) == 0 || (met == own) == kMerged || (kMerged && isLast != kComposites)) return;
    if (kMerged) keepIntervals();
    if (kMerged && kComposites) openLists(met);
  }
  index += kCube ? frame.cube.corner : frame.firstSeen;
  const vec3 position = samplePosition(frame.firstSample, frame.pitch, index);
  const vec3 components = alongAxes(position);
  if (marchAxis(position, components) != kAxis) return;
  keepFrame();

  SampleRay sampleRay;
  sampleRay.along = components[kAxis];
  sampleRay.world = frame.worldRay[0] * position.x + frame.worldRay[1] * position.y + frame.worldRay[2] * position.z;
  sampleRay.slope = vec2(dot(frame.axes[kAxis].slope[0], position), dot(frame.axes[kAxis].slope[1], position)) / sampleRay.along;
  sampleRay.middle = vec2(dot(frame.axes[kAxis].middle[0], position), dot(frame.axes[kAxis].middle[1], position)) / sampleRay.along;
  sampleRay.eye = dot(frame.axes[kAxis].eye, position);
  sampleRay.end = kHoldout ? holdoutAt(index) : 0.0;
  Sums sums = Sums(vec3(0.0), 0.0, 1.0, vec3(1.0));
  float distanceSum = 0.0;  // sum of e times world distance from the eye plane
  const int sampleIndex = index.x + index.y * frame.samples.x;
  vec3 colorBefore = vec3(0.0);
  if (kProjected) {
    marchLevel(sums, distanceSum, sampleRay, 0, true);
    Projected all = projectedOf(sums);
    all.distance = distanceSum;
    storeProjected(sampleIndex, all);
    return;
  }
#ifdef CONTINUES_SUMS
  const vec4 before = imageLoad(colorEnergy, sampleIndex);
  colorBefore = before.rgb;
  sums.transmittance -= before.a;
  distanceSum = imageLoad(distances, sampleIndex).x;
  if (kTinted) sums.colorTransmittance = pow(vec3(sums.transmittance), frame.deltaScale);
#endif
  // Scalars are marched apart from the levels of blocks behind them, so that neither loop has the code of the other: lavapipe executes
  // branches that no lane takes.
  if (kScalars) {
    if (kCube || frame.finest == 0) marchLevel(sums, distanceSum, sampleRay, 0, true);
  }
  // A cube has one level. With the loop, of which it inlines the bounds, lavapipe would compile the shader anew for each cube.
  if (kCube && !kScalars) {
    marchLevel(sums, distanceSum, sampleRay, 0, false);
  } else if (!kCube && (!kScalars || kLevels)) {
    for (int level = max(frame.finest, kScalars ? 1 : 0); level <= frame.coarsest; ++level)
      marchLevel(sums, distanceSum, sampleRay, level, false);
  }
  if (kMerged) {
    closeAllSlabs();
    if (kComposites) storeSums(sampleIndex, mergedColor, mergedTransmittance, mergedDistance);
    return;
  }
  storeSums(sampleIndex, colorBefore + frame.sourceUnit * sums.color, sums.transmittance, distanceSum);
}
