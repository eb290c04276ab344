// The light that a block of albedo 1 scatters towards the eye: Subr et al. 2007, Section 4.3. With kAnyView it is computed for all
// positions of the eye, to first order in the direction towards the eye; there must then be neither a phase function nor surfaces.
#ifndef LIGHTING_GLSL
#define LIGHTING_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "block_depth.glsl"
#include "code_bricks.glsl"
#include "phase_function.glsl"
#include "ray_lookup.glsl"
#include "self_attenuation.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ScatteredTexels { vec4 values[]; };
#define SCATTERED_TEXEL(i) ScatteredTexels(frame.lighting.scattered.texels).values[i]
#include "scattered_light.glsl"

const float kMaxRayDepth = 0.9999 * kOpaqueDepth;  // the end of the code of depths along rays

// The properties of a block as seen from the eye.
struct SeenBlock {
  Block block;
  uint rank;
  float sigma;
  vec3 toEye;      // unit vector in world space
  float own;       // optical depth towards the eye
  vec3 normal;     // of a surface; unit vector in world space
  float surface;   // fraction that is reflected like a surface, 0..1
};

// The depth at the block's centre. If that lies between two planes, the mean of the line of sight's depths on
// both.
float rayDepthOf(FaceRays fan, Block block, vec3 direction) {
  if (block.extent[fan.axis] % 2 == 1) return rayDepth(fan, block.center);
  return 0.5 * (rayDepth(fan, block.center + 0.5 * direction) + rayDepth(fan, block.center - 0.5 * direction));
}

// Gradient of the extinction by central differences, per block of its size, in index space; 0 outside.
vec3 extinctionGradient(Block block) {
  const BlockLevel level = frame.levels[block.level];
  vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    ivec3 before = block.cell, after = block.cell;
    --before[axis];
    ++after[axis];
    gradient[axis] = 0.5 * (extinctionOf(level, after) - extinctionOf(level, before));
  }
  return gradient;
}

// The gradient whose direction is the normal of a surface, in index space: that of the scalar where a transfer function is applied to it,
// as steps of the function would be steps of the extinction's.
vec3 normalGradient(Block block, vec3 ofExtinction) {
  const CodeBricks scalars = frame.lighting.scalars;
  if (block.level != 0 || scalars.codes == uvec2(0)) return ofExtinction;
  const float own = scalarOfCode(codeAt(scalars, frame.dimensions, block.cell));
  vec3 gradient = vec3(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    ivec3 before = block.cell, after = block.cell;
    --before[axis];
    ++after[axis];
    const float first = scalarOfCode(codeAt(scalars, frame.dimensions, before)), last = scalarOfCode(codeAt(scalars, frame.dimensions, after));
    gradient[axis] = (last == kNoScalar ? own : last) - (first == kNoScalar ? own : first);
  }
  return own != kNoScalar && dot(gradient, gradient) > 0.0 ? gradient : ofExtinction;
}

// The fraction of a light that reaches the parts of a block that the eye sees, if the eye is on the light's
// side of the block, and if it is on the other side.
struct Sides {
  vec3 same, other;
};

// The means over a block of its transmittance towards a light, each part weighted by the light that it sends
// to the eye; `own` is the block's optical depth towards the light. From the light's side the eye sees the
// lit parts (x), from the other side the dark ones (y).
vec2 meansSeen(SeenBlock seen, float own) {
  const float sameSide = selfAttenuation(seen.own + own);
  const float otherSide = exp(-min(seen.own, own)) * selfAttenuation(abs(seen.own - own));
  return vec2(sameSide, otherSide) / selfAttenuation(seen.own);
}

// The fraction of the light from a direction that reaches the visible parts of the block. `depth` and `unsaturated` are as in depthTowards.
Sides lightReaching(SeenBlock seen, vec3 direction, float depth, float unsaturated) {
  const float layer = layerLength(direction);
  const bool inFull = frame.lighting.lookup == kLookupExact || frame.pathLengthCorrection != 0;
  const float counted = inFull ? layer : frame.voxelSize;
  const float inFront = depthInFront(seen.block, direction, depth, unsaturated * seen.sigma * counted);
  const float own = seen.sigma * layer * float(layersOf(seen.block, direction));
  if (!kTinted) {
    const vec2 means = exp(-inFront) * meansSeen(seen, own);
    return Sides(vec3(means.x), vec3(means.y));
  }
  // At the end of its code a depth may be larger, and a tint would let light through.
  if (unsaturated == 0.0 || depth >= kMaxRayDepth) return Sides(vec3(0.0), vec3(0.0));
  Sides sides;
  for (int c = 0; c < 3; ++c) {
    const float tint = frame.lighting.tint[c];
    const vec2 means = exp(-tint * inFront) * meansSeen(seen, tint * own);
    sides.same[c] = means.x;
    sides.other[c] = means.y;
  }
  return sides;
}

// The light towards the eye. With kAnyView its mean over all directions d towards the eye; in direction d its
// luminance is 1 + dot(`towards`, d) times as large.
struct ScatteredLight {
  vec3 light, towards;
};

float luminanceOf(vec3 light) { return light.r + light.g + light.b; }

// `way` is the direction from which `light` comes, a unit vector in world space.
void addLight(inout ScatteredLight sum, SeenBlock seen, vec3 light, Sides sides, vec3 way) {
  if (kAnyView) {
    sum.light += 0.5 * light * (sides.same + sides.other);
    sum.towards += 0.5 * luminanceOf(light * (sides.same - sides.other)) * way;
  } else {
    sum.light += light * mix(sides.other, sides.same, 0.5 + 0.5 * dot(way, seen.toEye));
  }
}

// `light` is an index: copying a Light would copy all its rays.
void addScattered(inout ScatteredLight sum, int light, SeenBlock seen) {
  vec3 toLight = lights[light].place;
  float distance2 = 1.0;
  if (lights[light].atInfinity == 0) {
    toLight -= seen.block.center - frame.middle;
    const vec3 apart = frame.indexToWorld * toLight;
    const float edge = float(seen.block.edge) * frame.voxelSize;
    distance2 = max(dot(apart, apart), kNearestLight2 * edge * edge);
    if (dot(toLight, toLight) < kAtSource * kAtSource) toLight = vec3(0.0, 0.0, 1.0);
    toLight = acrossLayer(toLight);
  }
  float depth, unsaturated = 1.0;
  if (frame.lighting.lookup == kLookupExact)
    depth = rayDepthOf(lights[light].fans[fanIndex(-toLight)], seen.block, toLight);
  else
    depth = depthTowards(towardsSource(toLight, frame.lighting.lookup, lights[light].beyond), seen.rank, unsaturated);
  const vec3 way = normalize(frame.indexToWorld * toLight);
  float phase = kAnyView ? 1.0 / (4.0 * kPi) : phaseFunction(frame.lighting.phaseG, -way, seen.toEye);
  if (seen.surface > 0.0) phase = mix(phase, surfaceScattering(seen.normal, way, seen.toEye), seen.surface);
  addLight(sum, seen, lights[light].color * (phase / distance2), lightReaching(seen, toLight, depth, unsaturated), way);
}

// The scattered light for albedo 1. `towardsEye` is a unit vector in world space, `own` the block's optical
// depth in this direction.
ScatteredLight scatteredLight(Block block, float sigma, uint rank, vec3 towardsEye, float own) {
  SeenBlock seen = SeenBlock(block, rank, sigma, towardsEye, own, vec3(0.0), 0.0);
  if (!kAnyView && frame.lighting.surface > 0.0) {
    const vec3 gradient = extinctionGradient(block);
    // Where the extinction hardly changes there is no surface, and its normal would be noise.
    if (dot(gradient, gradient) > 0.0) {
      seen.normal = normalize(frame.lighting.gradientToWorld * normalGradient(block, gradient));
      seen.surface = frame.lighting.surface * min(2.0 * length(gradient) / sigma, 1.0);
    }
  }
  ScatteredLight sum = ScatteredLight(vec3(0.0), vec3(0.0));
  for (int i = 0; i < frame.lighting.lightCount; ++i) addScattered(sum, i, seen);
  if (frame.lighting.scattered.texels != uvec2(0))
    sum.light += scatteredLightAt(frame.lighting.scattered, !kAnyView && frame.lighting.scattered.moments > 1, seen.block.center, seen.toEye);
  return sum;
}

#endif
