// Voxels that are classified after interpolation, by integrals of the transfer function.
#ifndef GATHER_SCALARS_GLSL
#define GATHER_SCALARS_GLSL
#include "gather_blocks.glsl"
#include "transfer_table.glsl"

const float kMostlySurface = 0.95;        // surface share from which on other scattering is neglected

// The scalars of a quad's voxels, in intervals of the transfer function's table. Voxels without data lose their weights.
vec4 scalarsOf(int quad, inout vec4 weights) {
  const uvec2 pairs = mediumQuad(quad);
  const uvec4 codes = uvec4(pairs.x & 0xffffu, pairs.x >> 16, pairs.y & 0xffffu, pairs.y >> 16);
  [[unroll]] for (int i = 0; i < 4; ++i) weights[i] = codes[i] != 0 ? weights[i] : 0.0;
  return (vec4(codes) - 1.0) * (float(kTransferIntervals) / float(kScalarCodes));
}

float sumOf(vec4 weights) { return weights.x + weights.y + weights.z + weights.w; }

SliceValues scalarValuesAt(LevelGeometry level, vec2 position, int slice, vec3 toEye) {
  vec4 weights;
  const int quad = quadAt(level, position, slice, weights);
  const vec4 scalars = scalarsOf(quad, weights);
  SliceValues found;
  found.coverage = sumOf(weights);
  found.scalar = max(dot(weights, scalars) / max(found.coverage, 1e-20), 0.0);
  tableAt(found.scalar, found.integral, found.medium);
  found.gradient = vec3(0.0);
  found.depths = vec4(0.0);
  found.hasGradient = found.hasLight = false;
  found.light = vec3(1.0);
  if (kLit) {
    // Voxels that are not occupied have no light; that of the others counts.
    const uvec4 packed = sourceQuad(quad);
    [[unroll]] for (int i = 0; i < 4; ++i) weights[i] = packed[i] != 0 ? weights[i] : 0.0;
    found.light = sourceAt(quad, packed, weights, toEye) / max(sumOf(weights), 1e-20);
  }
  return found;
}

// The scalar between two slices, `fraction` of the way from the first to the second, at a position on the sides, and the coverage by voxels
// with data. LevelGeometry beyond the volume have no data.
vec2 scalarBetween(LevelGeometry level, vec2 position, int first, int second, float fraction) {
  vec2 sum = vec2(0.0);
  [[unroll]] for (int i = 0; i < 2; ++i) {
    const int slice = i == 0 ? first : second;
    vec4 weights;
    const bool isWithin = slice >= 0 && slice < level.count;  // the other one is, beside the volume's borders
    const int there = clamp(isWithin ? slice : i == 0 ? second : first, 0, level.count - 1);
    const vec4 scalars = scalarsOf(quadAt(level, position, there, weights), weights);
    const float share = isWithin ? i == 0 ? 1.0 - fraction : fraction : 0.0;
    sum += share * vec2(dot(weights, scalars), sumOf(weights));
  }
  return vec2(max(sum.x / max(sum.y, 1e-20), 0.0), sum.y);
}

// The same at a position in index space.
vec2 scalarNear(LevelGeometry level, vec3 position) {
  const int low = int(floor(position[kAxis]));
  return scalarBetween(level, vec2(position[kSideA], position[kSideB]), low, low + 1, position[kAxis] - float(low));
}

// Adds to the depths towards lights, which are known from a layer further on, the depths up to there. Where
// little is visible, the extinction is taken as constant on this path.
void addLayerTowards(inout vec4 depths, LevelGeometry level, SliceValues at, vec3 position, bool shows) {
  [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i) {
    if (i >= kLights) continue;
    const vec3 toLight = layerTowards(i, position).xyz;
    const float layer = length(kept.indexToWorld * toLight) * kept.extinctionUnit;
    if (!shows) {
      depths[i] += layer * at.coverage * at.medium.a;
      continue;
    }
    const vec2 next = scalarNear(level, position + toLight);
    vec4 integral, medium;
    tableAt(next.x, integral, medium);
    const float mean = at.coverage == 0.0 ? medium.a
                       : next.y == 0.0    ? at.medium.a
                                          : meanBetween(at.scalar, at.integral, at.medium, next.x, integral, medium).a;
    depths[i] += layer * 0.5 * (at.coverage + next.y) * mean;
  }
}

// Finds the light that reaches the ends of a stretch. The first end has its own already if another stretch ended there. The loop is as in
// findGradients().
void findLight(inout SliceValues last, inout SliceValues found, LevelGeometry level, Ray ray, int slice, bool shows) {
  const int before = slice - int(ray.direction);
  const bool enters = before < 0 || before >= level.count, leaves = slice < 0 || slice >= level.count;
  bool first = !last.hasLight && !enters, again, begun = false;
  do {
    const int there = first ? before : clamp(slice, 0, level.count - 1);
    const vec2 position = ray.origin + ray.slope * float(there);
    vec4 weights;
    const int quad = quadAt(level, position, there, weights);
    vec4 depths = depthsTowardsLights(quad, weights);
    continueDepths(depths, level, position);
    SliceValues at = found;
    if (first) at = last;
    const vec3 place = voxelPosition(ray, float(there));
    addLayerTowards(depths, level, at, place, shows);
    if (kClips) passClipped(depths, level, place, ray.edge, 1.0);
    at.depths = depths;
    if (first) last = at; else found = at;
    again = kPieces ? !begun : first;
    first = false;
    begun = true;
  } while (again);
  if (leaves) found.depths = depthsBeyond(slice, last.depths);
  if (enters) last.depths = depthsBeyond(before, found.depths);
  last.hasLight = found.hasLight = true;
}

// The relative change of the extinction from a scalar less `reach` to that plus `reach`, relative to the
// larger value.
float changeAcross(float scalar, float reach) {
  vec4 integral, above, below;
  tableAt(min(scalar + reach, float(kTransferIntervals)), integral, above);
  tableAt(max(scalar - reach, 0.0), integral, below);
  return (above.a - below.a) / max(max(above.a, below.a), 1e-20);
}

// The values at the ends of a stretch; where an end has no data, those of the other end.
void endsOf(out SliceValues first, out SliceValues second, SliceValues last, SliceValues found) {
  first = last;
  second = found;
  if (last.coverage == 0.0) first = found;
  if (found.coverage == 0.0) second = last;
}

// Lights the two halves of a stretch. `shown` is the stretch's share of the pixel's alpha.
void lightStretch(out SegmentLight nearLit, out SegmentLight farLit, inout SliceValues last, inout SliceValues found, float nearExtinction,
                  float farExtinction, float shown, LevelGeometry level, Ray ray, int slice) {
  nearLit.position = farLit.position = voxelPosition(ray, float(slice) - 0.5 * ray.direction);
  vec3 outwards = vec3(0.0);
  bool shows = shown > kMinShaded;
  if (kSurfaces) {
    nearLit.surface = farLit.surface = 0.0;
    nearLit.scatteredOffset = farLit.scatteredOffset = vec3(0.0);
    if (shown > 2.0 * kMinShaded) {
      findGradients(last, found, level, ray, slice);
      SliceValues first, second;
      endsOf(first, second, last, found);
      const vec3 nearGradient = mix(last.gradient, found.gradient, 0.25), farGradient = mix(last.gradient, found.gradient, 0.75);
      const float nearChange = changeAcross(mix(first.scalar, second.scalar, 0.25), length(nearGradient));
      const float farChange = changeAcross(mix(first.scalar, second.scalar, 0.75), length(farGradient));
      setSurface(nearLit, nearGradient, -nearChange);
      setSurface(farLit, farGradient, -farChange);
      outwards = -sign(nearChange + farChange) * (nearGradient + farGradient);
    }
    shows = shows && min(nearLit.surface, farLit.surface) < kMostlySurface;
  }
  findLight(last, found, level, ray, slice, shows);
  // Along a stretch the depth towards a light changes as the depth towards the eye does, since both are
  // integrals of the same extinction.
  const float nearPart = nearExtinction / (nearExtinction + farExtinction);
  nearLit.begin = last.depths;
  nearLit.change = (found.depths - last.depths) * nearPart;
  farLit.begin = nearLit.begin + nearLit.change;
  farLit.change = found.depths - farLit.begin;
  if (kSurfaces && shown > 2.0 * kMinShaded) {
    const Outside outside = outsideOf(level, ray, float(slice) - 0.5 * ray.direction, outwards);
    lightFrom(nearLit, outside);
    lightFrom(farLit, outside);
  }
}

// A scalar and what the transfer function makes of it.
struct ClassifiedScalar {
  float scalar;
  vec4 integral, medium;
};

// The mean of extinction times colour and extinction between two scalars of a stretch, with kQuarters by another one between them, which is
// `fraction` of the stretch from its first slice.
vec4 meanOfScalars(LevelGeometry level, Ray ray, int before, int slice, bool within, float fraction, ClassifiedScalar from,
                   ClassifiedScalar to) {
  const vec4 mean = meanBetween(from.scalar, from.integral, from.medium, to.scalar, to.integral, to.medium);
  if (!kQuarters) return mean;
  const vec2 position = ray.origin + ray.slope * mix(float(before), float(slice), fraction);
  const vec2 quarter = scalarBetween(level, position, before, within ? slice : -1, fraction);
  vec4 integral, medium;
  tableAt(quarter.x, integral, medium);
  const vec4 means = meanBetween(from.scalar, from.integral, from.medium, quarter.x, integral, medium) +
                     meanBetween(quarter.x, integral, medium, to.scalar, to.integral, to.medium);
  return quarter.y > 0.0 ? mix(mean, 0.5 * means, kept.quarters) : mean;
}

// The stretch from the previous slice to this one. Scalars change linearly from a slice to the middle of the stretch and on to the next
// slice, so that integrals of the transfer function give the means. In the middle the scalar is interpolated between all eight voxels around.
// Where stretches are long, so it is at their quarters.
// A slice that is not `within` the level's slices has no data.
Stretch scalarStretch(SliceValues last, LevelGeometry level, Ray ray, int slice, bool within) {
  Stretch stretch;
  stretch.slice = slice;
  const int before = slice - int(ray.direction);
  const vec2 middle = scalarBetween(level, ray.origin + ray.slope * (float(slice) - 0.5 * ray.direction), before, within ? slice : -1, 0.5);
  const int there = within ? slice : before;
  SliceValues found = scalarValuesAt(level, ray.origin + ray.slope * float(there), there, ray.toEye);
  if (!within) found.coverage = 0.0;
  SliceValues first, second;
  endsOf(first, second, last, found);
  float scalar = middle.y > 0.0 ? middle.x : first.scalar;
  if (kHoldout) {  // the ends of what is in front of the ray's end
    const float seen = ray.reach - ((float(slice) - ray.eye) * ray.direction - 1.0);
    const float middleScalar = scalar;
    scalar = mix(first.scalar, middleScalar, clamp(2.0 * seen, 0.0, 1.0));
    if (seen < 1.0) {
      second.scalar = mix(middleScalar, second.scalar, clamp(2.0 * seen - 1.0, 0.0, 1.0));
      tableAt(second.scalar, second.integral, second.medium);
    }
  }
  vec4 integral, medium;
  tableAt(scalar, integral, medium);
  const ClassifiedScalar between = ClassifiedScalar(scalar, integral, medium);
  const ClassifiedScalar begin = ClassifiedScalar(first.scalar, first.integral, first.medium);
  const ClassifiedScalar end = ClassifiedScalar(second.scalar, second.integral, second.medium);
  stretch.near = meanOfScalars(level, ray, before, slice, within, 0.25, begin, between);
  stretch.far = meanOfScalars(level, ray, before, slice, within, 0.75, between, end);
  stretch.coverage = middle.y;
  stretch.adds = last.coverage + middle.y + found.coverage > 0.0 && stretch.near.a + stretch.far.a > 0.0;
  if (kCube) stretch.adds = stretch.adds && isOwn(level, ray.origin + ray.slope * float(there), there);
  stretch.end = found;
  return stretch;
}

void addScalarStretch(inout Sums sums, inout SliceValues last, Stretch stretch, LevelGeometry level, Ray ray) {
  SliceValues found = stretch.end, first, second;
  endsOf(first, second, last, found);
  const int slice = stretch.slice;
  vec4 near = stretch.near, far = stretch.far;
  if (kLit) {
    near.rgb *= mix(first.light, second.light, 0.25);
    far.rgb *= mix(first.light, second.light, 0.75);
  }
  // Coverage is linear in both halves, of which the parts in front of the eye count.
  const float ahead = (float(slice) - ray.eye) * ray.direction;
  const vec3 nearPart = halfStretch(ray, ahead - 0.5), farPart = halfStretch(ray, ahead);
  // How far the middles of these parts are from the ends of the halves, in halves.
  const float nearMiddle = kHoldout ? 2.0 * (ahead - 0.5 - nearPart.y) : nearPart.x, farMiddle = kHoldout ? 2.0 * (ahead - farPart.y) : farPart.x;
  const float nearLayer = ray.layer * mix(stretch.coverage, last.coverage, nearMiddle);
  const float farLayer = ray.layer * mix(found.coverage, stretch.coverage, farMiddle);
  const float shown = sums.transmittance * (nearLayer * near.a + farLayer * far.a);
  SegmentLight nearLit, farLit;
  if (kSampled) {
    lightStretch(nearLit, farLit, last, found, near.a, far.a, shown, level, ray, slice);
    if (kHoldout) {
      nearLit.change *= 2.0 * nearPart.x;
      farLit.change *= 2.0 * farPart.x;
    }
  }
  addHalfSegments(sums, HalfSegment(near, nearLayer, nearPart), HalfSegment(far, farLayer, farPart), nearLit, farLit, ray);
  last = found;
}

#endif
