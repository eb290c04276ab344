// Projections of the scalars along a ray, of the largest or of their mean (frame.projection), to which the transfer function gives colour and
// opacity.
#ifndef GATHER_PROJECTION_GLSL
#define GATHER_PROJECTION_GLSL
#include "gather_scalars.glsl"

const float kMinCoverage = 0.5;  // where a scalar may be the largest: within the voxels with data, and not in the fringe around them

const float kStepsOfVoxel = 4.0;   // at least, along a ray

// What a ray projects. `largest` is used for kMaxIntensity, `sum` and `coverage` for kAverageIntensity.
struct Projected {
  float largest;   // scalar plus 1, or 0 if there is none
  float sum;       // of scalars times their coverage
  float coverage;  // sum
  float distance;  // of the largest scalar from the eye, or the sum of the distances of all times their coverage
};

// In Sums, while a ray is marched; the distance is then in slices.
Projected projectedOf(Sums sums) { return Projected(sums.color.x, sums.color.y, sums.color.z, sums.distance); }

void joinProjected(inout Projected all, Projected more) {
  if (frame.projection == kMaxIntensity) {
    if (more.largest > all.largest) all = more;
  } else {
    all = Projected(0.0, all.sum + more.sum, all.coverage + more.coverage, all.distance + more.distance);
  }
}

void project(inout Sums sums, float scalar, float coverage, float ahead, Ray ray, bool counts) {
  const bool maximum = frame.projection == kMaxIntensity;
  const bool isSeen = counts && ahead >= 0.0 && (!kHoldout || ahead <= ray.reach);
  Projected all = projectedOf(sums);
  if (isSeen && coverage >= (maximum ? kMinCoverage : 0.0))
    joinProjected(all, Projected(scalar + 1.0, coverage * scalar, coverage, maximum ? ahead : coverage * ahead));
  sums.color = vec3(all.largest, all.sum, all.coverage);
  sums.distance = all.distance;
}

// Adds the scalars at equal steps from the slice before, which is left out, to this one. A slice that is not `within` the level's slices has no
// data.
void addProjected(inout Sums sums, inout SliceValues last, LevelGeometry level, Ray ray, int slice, bool within) {
  const int before = slice - int(ray.direction), steps = int(ceil(kStepsOfVoxel * sqrt(1.0 + dot(ray.slope, ray.slope))));
  int i = 1;
  bool more;
  do {
    if (i <= steps) {
      const float part = float(i) / float(steps), at = float(slice) - ray.direction * (1.0 - part);
      const vec2 position = ray.origin + ray.slope * at, found = scalarBetween(level, position, before, within ? slice : -1, part);
      project(sums, found.x, found.y, (at - ray.eye) * ray.direction, ray, isOwn(level, position, within ? slice : before));
      last.coverage = found.y;
    }
    more = ++i <= steps;
  } while (more);
}

// Premultiplied colour and opacity, and the distance times the opacity, of what is projected.
vec4 colorOf(Projected all, out float distance) {
  const bool largest = frame.projection == kMaxIntensity;
  distance = 0.0;
  if ((largest ? all.largest : all.coverage) == 0.0) return vec4(0.0);
  vec4 integral, medium;
  tableAt(largest ? all.largest - 1.0 : all.sum / all.coverage, integral, medium);
  const float opacity = 1.0 - exp(-frame.projectionLayer * medium.a);
  distance = opacity * (largest ? all.distance : all.distance / all.coverage);
  return vec4(opacity * kept.sourceUnit * medium.rgb / max(medium.a, 1e-30), opacity);
}

#endif
