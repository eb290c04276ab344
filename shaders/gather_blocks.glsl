// Blocks that are classified: source term and extinction are interpolated.
#ifndef GATHER_BLOCKS_GLSL
#define GATHER_BLOCKS_GLSL
#include "gather_surfaces.glsl"
#include "packed_light.glsl"

vec3 sumOf(uvec4 packed, vec4 weights) {
  vec3 sum = vec3(0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) sum += weights[i] * unpackLight(packed[i]);
  return sum;
}

// The sum of a quad's source terms.
vec3 sourceAt(int quad, uvec4 packed, vec4 weights, vec3 toEye) {
  if (kTowards) {
    const uvec4 towards = extraQuad(quad);
    [[unroll]] for (int i = 0; i < 4; ++i) weights[i] *= 1.0 + dot(unpackSnorm4x8(towards[i]).xyz, toEye);
  }
  return sumOf(packed, weights);
}

// The fraction of a slice's tent that is in front of the eye, if the slice is `ahead` slices in front of it.
float fractionInFront(float ahead) {
  const float a = clamp(ahead, -1.0, 1.0);
  return a >= 0.0 ? 0.5 + a - 0.5 * a * a : 0.5 * (1.0 + a) * (1.0 + a);
}

vec4 extinctionsOf(int quad) {
  const uvec2 halves = mediumQuad(quad);
  return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
}

// The interpolated source term and extinction.
vec4 mediumAt(int quad, vec4 weights, vec4 extinctions, vec3 toEye) {
  const float extinction = dot(weights, extinctions);
  return vec4(kColored ? sourceAt(quad, sourceQuad(quad), weights, toEye) : extinction * kept.color, extinction);
}

// For classified blocks: source term and extinction are constant in a slice's layer.
void addSlice(inout Sums sums, LevelGeometry level, Ray ray, int slice) {
  vec4 weights;
  const vec2 position = ray.origin + ray.slope * float(slice);
  const int quad = quadAt(level, position, slice, weights);
  const float ahead = (float(slice) - ray.eye) * ray.direction;
  const vec4 medium = mediumAt(quad, weights, extinctionsOf(quad), ray.toEye);
  if (kCube && (!isOwn(level, position, slice) || medium == vec4(0.0))) return;
  SegmentLight lit;
  SlabPart none;
  addSegment(none, sums, medium, ray.layer * fractionInFront(ahead), ahead, 0.5, lit, ray);
}

// For classified blocks that are lit at samples: the values on a slice.
SliceValues blockValuesAt(LevelGeometry level, Ray ray, int slice, bool within) {
  vec4 weights;
  const vec2 position = ray.origin + ray.slope * float(slice);
  const int quad = quadAt(level, position, slice, weights);
  SliceValues found;
  found.medium = within ? mediumAt(quad, weights, extinctionsOf(quad), ray.toEye) : vec4(0.0);
  found.depths = depthsTowardsLights(quad, weights);
  continueDepths(found.depths, level, position);
  if (kClips) passClipped(found.depths, level, voxelPosition(ray, float(slice)), ray.edge, 0.0);
  found.emission = kEmits && within ? sumOf(extraQuad(quad), weights) : vec3(0.0);
  found.coverage = found.medium.a > 0.0 || (kEmits && found.emission != vec3(0.0)) ? 1.0 : 0.0;
  found.hasLight = true;
  found.gradient = vec3(0.0);
  found.hasGradient = false;
  return found;
}

// The mean light that leaves a stretch, of what is emitted along it. The halves have the values of their slices, as layers have without
// lights: flames often end where smoke begins, so that the product of the means would be too dark. `stretch` is in units of 1 / extinction.
vec3 leavingEmission(SliceValues last, SliceValues found, float stretch) {
  const float near = 0.5 * stretch * last.medium.a, far = 0.5 * stretch * found.medium.a;
  return 0.5 * (meanTransmittance(near) * last.emission + exp(-near) * meanTransmittance(far) * found.emission);
}

// The medium in the middle between two slices, between all eight blocks around: source term and extinction. LevelGeometry beyond the volume have none.
vec4 mediumBetween(LevelGeometry level, Ray ray, int first, int second) {
  const vec2 position = ray.origin + ray.slope * (0.5 * float(first + second));
  vec4 sum = vec4(0.0);
  [[unroll]] for (int i = 0; i < 2; ++i) {
    const int slice = i == 0 ? first : second;
    vec4 weights;
    const int quad = quadAt(level, position, clamp(slice, 0, level.count - 1), weights);
    const vec4 medium = mediumAt(quad, weights, extinctionsOf(quad), ray.toEye);
    if (slice >= 0 && slice < level.count) sum += 0.5 * medium;
  }
  return sum;
}

// The medium of half a stretch from `first` to `second`, as far as that is in front of the ray's end. With kHoldout the eye is taken to be
// in front of the half.
vec4 meanOfHalf(vec4 first, vec4 second, vec3 part) { return kHoldout ? mix(first, second, part.x) : 0.5 * (first + second); }

// Where no stencil restores footprints, beside other volumes and in front of a holdout: a stretch in two halves, whose means are those of
// the ends and the middle.
void addHalves(inout Sums sums, SliceValues last, SliceValues found, LevelGeometry level, Ray ray, int slice, float ahead, SegmentLight lit) {
  const vec4 middle = mediumBetween(level, ray, slice - int(ray.direction), slice);
  const vec3 near = halfStretch(ray, ahead - 0.5), far = halfStretch(ray, ahead);
  const vec4 nearMedium = meanOfHalf(last.medium, middle, near), farMedium = meanOfHalf(middle, found.medium, far);
  SegmentLight farLit = lit;
  lit.change *= 0.5;
  farLit.begin += lit.change;
  farLit.change = lit.change;
  if (kHoldout) {
    lit.change *= 2.0 * near.x;
    farLit.change *= 2.0 * far.x;
  }
  if (kEmits) {
    lit.emission = last.emission;
    farLit.emission = found.emission;
    if (!kMerged) {  // where slabs do not dim it
      lit.emission *= meanTransmittance(ray.layer * near.x * nearMedium.a);
      farLit.emission *= meanTransmittance(ray.layer * far.x * farMedium.a);
    }
  }
  addHalfSegments(sums, HalfSegment(nearMedium, ray.layer, near), HalfSegment(farMedium, ray.layer, far), lit, farLit, ray);
}

// For classified blocks that are lit at samples: the stretch from the previous slice. The depth towards a
// light changes along it as the depth towards the eye does, since both are integrals of the same extinction.
void addBlockStretch(inout Sums sums, inout SliceValues last, LevelGeometry level, Ray ray, int slice, bool within) {
  const int there = within ? slice : slice - int(ray.direction);
  SliceValues found = blockValuesAt(level, ray, there, within);
  const vec4 medium = 0.5 * (last.medium + found.medium);
  if (kCube) {
    if (!isOwn(level, ray.origin + ray.slope * float(there), there) || (!kHoldout && medium == vec4(0.0) && (!kEmits || last.emission + found.emission == vec3(0.0)))) {
      last = found;
      return;
    }
  }
  const float ahead = (float(slice) - ray.eye) * ray.direction;
  SegmentLight lit;
  const int before = slice - int(ray.direction);
  if (!last.hasLight) last.depths = max(found.depths - ray.layer * medium.a, vec4(0.0));  // as slices without blocks were skipped
  if (before < 0 || before >= level.count) last.depths = depthsBeyond(before, found.depths);
  if (slice < 0 || slice >= level.count) found.depths = depthsBeyond(slice, last.depths);
  lit.begin = last.depths;
  lit.change = found.depths - lit.begin;
  lit.position = voxelPosition(ray, float(slice) - 0.5 * ray.direction);
  if (kSurfaces) {
    lit.surface = 0.0;
    lit.scatteredOffset = vec3(0.0);
    if (sums.transmittance * ray.layer * medium.a > kMinShaded) {
      findGradients(last, found, level, ray, slice);
      const vec3 gradient = 0.5 * (last.gradient + found.gradient);
      const float reach = length(gradient) / kept.extinctionUnit;
      setSurface(lit, gradient, -min(2.0 * reach / max(medium.a + reach, 1e-20), 1.0));
      lightFrom(lit, outsideOf(level, ray, float(slice) - 0.5 * ray.direction, -gradient));
    }
  }
  if (kMerged || kHoldout) {
    addHalves(sums, last, found, level, ray, slice, ahead, lit);
  } else {
    const float stretch = ray.layer * clamp(ahead, 0.0, 1.0);
    if (kEmits) lit.emission = leavingEmission(last, found, stretch);
    SlabPart none;
    addSegment(none, sums, medium, stretch, ahead - 0.5, 0.5, lit, ray);
  }
  last = found;
}

#endif
