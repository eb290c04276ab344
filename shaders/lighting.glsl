// What a block of albedo 1 scatters towards the eye of the light that it gets: Subr et al. 2007, Section 4.3. Include after
// block_depth.glsl and self_attenuation.glsl; `frame` is the SetupFrame, `lights` its lights. kAnyView says whether the
// light is wanted for all positions of the eye, to first order in the direction towards it: then there must be neither a
// phase function nor surfaces.

#include "phase_function.glsl"

const float kMostRayDepth = 0.9999 * kOpaqueDepth;  // the end of the code of rays

// A block as the eye sees it.
struct SeenBlock {
  Block block;
  uint rank;
  float sigma;
  vec3 toEye;      // in the world, of length 1
  float own;       // optical depth towards the eye
  vec3 normal;     // of a surface, in the world, of length 1
  float surface;   // how much of one it is
};

// Of the extinction, by central differences, per block of its size, index space; 0 outside.
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

// In the place of the phase function, after Blinn; both sides are alike.
float surfaceScattering(vec3 normal, vec3 toLight, vec3 toEye) {
  const vec3 between = toLight + toEye;
  const float facing = min(abs(dot(normal, between)) / max(length(between), 1e-6), 1.0);
  const float highlight = (kHighlightExponent + 1.0) / (8.0 * kPi) * pow(facing, kHighlightExponent);
  return (1.0 - kHighlight) * abs(dot(normal, toLight)) / (2.0 * kPi) + kHighlight * highlight;
}

// What of a light reaches the parts of a block that the eye sees, were it on the light's side of the block, and on the
// other one.
struct Sides {
  vec3 same, other;
};

// The means over a block of what it lets through towards a light, `own` its optical depth there, each part weighted by
// what it sends to the eye. Seen from the light's side the parts that the eye sees are those in the light (x), from the
// other side those in the dark (y).
vec2 meansSeen(SeenBlock seen, float own) {
  const float sameSide = selfAttenuation(seen.own + own);
  const float otherSide = exp(-min(seen.own, own)) * selfAttenuation(abs(seen.own - own));
  return vec2(sameSide, otherSide) / selfAttenuation(seen.own);
}

// What of the light from a direction reaches what is seen of the block, in an octave of scattering that multiplies optical
// depths by `scale`. `depth` and `falling` as depthTowards has them.
Sides reaching(SeenBlock seen, vec3 direction, float depth, float falling, float scale) {
  const float layer = layerLength(direction);
  const bool inFull = frame.lighting.lookup == kLookupExact || frame.pathLengthCorrection != 0;
  const float counted = inFull ? layer : frame.voxelSize;
  const float inFront = scale * depthInFront(seen.block, direction, depth, falling * seen.sigma * counted);
  const float own = scale * seen.sigma * layer * float(layersOf(seen.block, direction));
  if (!kTinted) {
    const vec2 means = exp(-inFront) * meansSeen(seen, own);
    return Sides(vec3(means.x), vec3(means.y));
  }
  // At the end of its code a depth may be any larger one, and a tint would let light through.
  if (falling == 0.0 || depth >= kMostRayDepth) return Sides(vec3(0.0), vec3(0.0));
  Sides sides;
  for (int c = 0; c < 3; ++c) {
    const float tint = frame.lighting.tint[c];
    const vec2 means = exp(-tint * inFront) * meansSeen(seen, tint * own);
    sides.same[c] = means.x;
    sides.other[c] = means.y;
  }
  return sides;
}

// Towards the eye; with kAnyView the mean over all directions d towards it, and for each the share 1 + dot(`towards`, d)
// of its luminance.
struct ScatteredLight {
  vec3 light, towards;
};

float luminanceOf(vec3 light) { return light.r + light.g + light.b; }

// `way` is the direction towards where `light` comes from, in the world and of length 1.
void addLight(inout ScatteredLight sum, SeenBlock seen, vec3 light, Sides sides, vec3 way) {
  if (kAnyView) {
    sum.light += 0.5 * light * (sides.same + sides.other);
    sum.towards += 0.5 * luminanceOf(light * (sides.same - sides.other)) * way;
  } else {
    sum.light += light * mix(sides.other, sides.same, 0.5 + 0.5 * dot(way, seen.toEye));
  }
}

// `light` is a number: a copy of a Light would be of all its rays.
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
  float depth, falling = 1.0;
  if (frame.lighting.lookup == kLookupExact)
    depth = rayDepthOf(lights[light].fans[fanIndex(-toLight)], seen.block, toLight).x;
  else
    depth = depthTowards(towardsSource(toLight, frame.lighting.lookup, lights[light].beyond), seen.rank, falling);
  const vec3 way = normalize(frame.indexToWorld * toLight);
  float scale = 1.0;
  for (int octave = 0; octave < frame.lighting.octaves; ++octave) {
    float phase = kAnyView ? 1.0 / (4.0 * kPi) : phaseFunction(scale * frame.lighting.phaseG, -way, seen.toEye);
    if (seen.surface > 0.0)
      phase = mix(phase, octave == 0 ? surfaceScattering(seen.normal, way, seen.toEye) : 0.0, seen.surface);
    const vec3 arriving = lights[light].color * (scale * phase / distance2);
    addLight(sum, seen, arriving, reaching(seen, toLight, depth, falling, scale), way);
    scale *= frame.lighting.octaveScale;
  }
}

// The mean of the radiance that reaches the block from all directions, weighted by the phase function: what is dark from
// everywhere is dark in ambient light. The weights of a narrow phase function at a few directions do not add up to 1, so the
// sum is divided by theirs.
void addFromEverywhere(inout ScatteredLight total, SeenBlock seen) {
  ScatteredLight sum = ScatteredLight(vec3(0.0), vec3(0.0));
  float weights = 0.0, parts = 0.0;
  const TableLookup towards = towardsSource(vec3(0.0, 0.0, 1.0), kLookupBilinear, uvec2(0));
  const int edge = 2 * frame.cells + 1;
  const uint place = codePlace(frame.cells, seen.rank);
  for (int i = 0; i < edge * edge * edge; ++i) {
    const vec4 fromThere = frame.lighting.ambientByDirection[i];
    if (fromThere.w == 0.0) continue;  // no direction: inside of the cube
    const ivec3 cell = ivec3(i % edge, i / edge % edge, i / edge / edge) - frame.cells;
    const float depth = decodeDepth(frame.code, storedCode(towards, cell, place));
    const float falling = isAtEnd(towards, cell, place) ? 0.0 : 1.0;
    const vec3 direction = vec3(cell) / float(frame.cells);
    const vec3 way = normalize(frame.indexToWorld * direction);
    float scale = 1.0;
    for (int octave = 0; octave < frame.lighting.octaves; ++octave) {
      const float phase =
          kAnyView || frame.lighting.phaseG == 0.0 ? 1.0 : 4.0 * kPi * phaseFunction(scale * frame.lighting.phaseG, -way, seen.toEye);
      weights += fromThere.w * scale * phase;
      parts += fromThere.w * scale;
      addLight(sum, seen, scale * phase * fromThere.rgb, reaching(seen, direction, depth, falling, scale), way);
      scale *= frame.lighting.octaveScale;
    }
  }
  total.light += parts / weights * sum.light;
  total.towards += parts / weights * sum.towards;
}

// Per albedo. `towardsEye` is the world's direction of length 1 in which the light is sent, `own` the block's optical
// depth in it.
ScatteredLight scatteredLight(Block block, float sigma, uint rank, vec3 towardsEye, float own) {
  SeenBlock seen = SeenBlock(block, rank, sigma, towardsEye, own, vec3(0.0), 0.0);
  if (!kAnyView && frame.lighting.surface > 0.0) {
    const vec3 gradient = extinctionGradient(block);
    const vec3 normal = frame.lighting.gradientToWorld * gradient;
    // Where the extinction hardly changes there is no surface, and its normal is noise.
    if (dot(gradient, gradient) > 0.0) {
      seen.normal = normalize(normal);
      seen.surface = frame.lighting.surface * min(2.0 * length(gradient) / sigma, 1.0);
    }
  }
  ScatteredLight sum = ScatteredLight(vec3(0.0), vec3(0.0));
  for (int i = 0; i < frame.lighting.lightCount; ++i) addScattered(sum, i, seen);
  if (frame.lighting.hasAmbient != 0) addFromEverywhere(sum, seen);
  return sum;
}
