// The light that a segment of a ray scatters to the eye, and its addition to the ray's sums.
#ifndef GATHER_LIGHT_GLSL
#define GATHER_LIGHT_GLSL
#include "gather_march.glsl"
#include "gather_slabs.glsl"
#include "phase_function.glsl"
#define SCATTERED_TEXEL(i) texelFetch(scatteredTexels, i)
#include "scattered_light.glsl"

const float kMaxLightDepth = 0.99 * kOpaqueDepth;  // approximately the end of the code of depths along rays

// The light that arrives at a segment of a ray, and that it emits.
struct SegmentLight {
  vec4 begin, change;   // optical depths towards the lights at the segment's beginning, and their change along it
  vec3 position;        // of the segment's middle, in index space
  vec3 scatteredOffset;  // from there to where scattered light is looked up; only with kSurfaces
  vec3 normal;          // outward unit normal of a surface there, in world space
  float surface;        // fraction of the light that is reflected as by a surface, 0..1
  vec4 outside;         // optical depths towards the lights from a point outside of the surface
  vec3 emission;        // source term of the light that leaves the segment, of what it emits; only with kEmits
};

// What a surface adds to the sum of lightOf(). A surface that faces the light is not shadowed by its
// own voxels, which would take half of the light on average.
vec3 surfaceLight(SegmentLight lit, int light, vec3 toLight, vec3 depth, vec3 toEye) {
  const bool facing = dot(lit.normal, toLight) > 0.0;
  const float begin = facing ? lit.outside[light] : lit.begin[light], change = facing ? 0.0 : lit.change[light];
  const vec3 tint = kTinted ? kept.tint : vec3(1.0);
  vec3 through;
  [[unroll]] for (int c = 0; c < 3; ++c) through[c] = exp(-tint[c] * begin) * meanTransmittance(depth[c] + tint[c] * change);
  return lit.surface * (facing ? 0.5 : 1.0) * surfaceScattering(lit.normal, toLight, toEye) * through;
}

// The light of one source that a segment scatters to the eye, for albedo 1: its mean over the segment, attenuated by what lies in front
// within the segment. `depth` is the segment's optical depth for light.
vec3 lightOf(int light, SegmentLight lit, vec3 depth, vec3 toEye) {
  // Values are selected, as lavapipe would compile the shader anew for uniforms on which a branch depends.
  const SampleLight source = kept.lights[light];
  const bool atInfinity = source.atInfinity != 0;
  const vec3 apart = kept.indexToWorld * (source.positionOrDirection - lit.position);
  const float apart2 = dot(apart, apart);
  const vec3 toLight = mix(apart * inversesqrt(max(apart2, 1e-30)), source.positionOrDirection, bvec3(atInfinity));
  const float distance2 = mix(max(apart2, kept.nearestLight2), 1.0, atInfinity);
  const float begin = lit.begin[light], change = lit.change[light];
  // A stored depth at the end of its range stands for any larger one; times a tint below 1 it would let light through.
  if (kTinted && begin + max(change, 0.0) >= kMaxLightDepth) return vec3(0.0);
  float phase = mix(phaseFunction(kept.phaseG, -toLight, toEye), 1.0 / (4.0 * kPi), kept.phaseG == 0.0);
  if (kSurfaces) phase *= 1.0 - lit.surface;
  vec3 sum;
  if (kTinted)
    [[unroll]] for (int c = 0; c < 3; ++c) sum[c] = phase * exp(-kept.tint[c] * begin) * meanTransmittance(depth[c] + kept.tint[c] * change);
  else
    sum = vec3(phase * exp(-begin) * meanTransmittance(depth.r + change));
  if (kSurfaces && lit.surface > 0.0) sum += surfaceLight(lit, light, toLight, depth, toEye);
  return source.color / distance2 * sum;
}

// Adds a segment of the ray with a constant source term (rgb) and extinction (a), whose middle is `ahead` slices from the eye, and which
// reaches `reach` slices from there. The light that leaves it is dimmed by the mean of its own transmittance, or with kMerged by that of
// the slabs in which it is, to which the caller adds `part`. `segmentLength` is in units of 1 / extinction.
void addSegment(out SlabPart part, inout Sums sums, vec4 medium, float segmentLength, float ahead, float reach, SegmentLight lit, Ray ray) {
  const vec3 toEye = ray.toEye;
  const float depth = segmentLength * medium.a;
  const float through = exp(-depth);
  const float rest = sums.transmittance * through;
  const float own = depth < 0.01 ? 1.0 - 0.5 * depth : (1.0 - through) / depth;
  vec3 leaving = vec3(own), depths = vec3(depth), before = vec3(sums.transmittance);
  if (kTinted) {  // what is scattered forwards within the segment goes on
    depths = kSampled ? depth - segmentLength * kept.forward * kept.sourceUnit * medium.rgb : depth * kept.deltaScale;
    [[unroll]] for (int c = 0; c < 3; ++c) leaving[c] = meanTransmittance(depths[c]);
    before = sums.colorTransmittance;
    sums.colorTransmittance *= exp(-depths);
  }
  vec3 within = depths;  // the optical depth that dims the segment's own light
  if (kMerged) {
    leaving = vec3(1.0);
    within = vec3(0.0);
  }
  if (kSampled) {
    leaving = kScattered ? leaving * scatteredLightAt(kept.scattered, kFlux, kSurfaces ? lit.position + lit.scatteredOffset : lit.position, toEye) : vec3(0.0);
    [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i)
      if (i < kLights) leaving += lightOf(i, lit, within, toEye);
  }
  vec3 source = leaving * medium.rgb;
  if (kEmits) source += lit.emission;
  if (kMerged)
    part = SlabPart(vec4(segmentLength * kept.sourceUnit * source, depth), depths);
  else
    sums.color += before * segmentLength * source;
  sums.distance += (sums.transmittance - rest) * max(ahead, 0.0);
  sums.transmittance = rest;
}

// A half of a stretch between two slices. `place` is as of halfStretch(), `layer` the length of a slice in units of 1 / extinction.
struct HalfSegment {
  vec4 medium;
  float layer;
  vec3 place;
};

void addHalfSegments(inout Sums sums, HalfSegment near, HalfSegment far, SegmentLight nearLit, SegmentLight farLit, Ray ray) {
  SlabPart nearPart, farPart;
  addSegment(nearPart, sums, near.medium, near.layer * near.place.x, near.place.y, near.place.z, nearLit, ray);
  addSegment(farPart, sums, far.medium, far.layer * far.place.x, far.place.y, far.place.z, farLit, ray);
  const vec3 borders = vec3(near.place.y - near.place.z, near.place.y + near.place.z, far.place.y + far.place.z);
  if (kMerged) addToSlabs(nearPart, farPart, ray.perSlice * max(borders, 0.0));
}

float lightDepth(int slot, int quad, vec4 weights) {
  const uvec2 pairs = lightQuad(slot, quad);
  const float root = dot(weights, vec4(unpackUnorm2x16(pairs.x), unpackUnorm2x16(pairs.y)));
  return root * root * kOpaqueDepth;
}

// The optical depths towards the lights that a quad has. Blocks beyond the volume have none.
vec4 depthsTowardsLights(int quad, vec4 weights) {
  vec4 depths = vec4(0.0);
  [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i)
    if (i < kLights) depths[i] = lightDepth(i, quad, weights);
  return depths;
}

// The way from a position in index space to a light: a vector whose longest component is a voxel, and how many times its length the light is
// away.
vec4 layerTowards(int light, vec3 position) {
  const vec3 toLight = kept.lights[light].positionOrDirection - position;
  const float layers = max(max(abs(toLight.x), max(abs(toLight.y), abs(toLight.z))), 1e-6);
  return mix(vec4(toLight / layers, layers), vec4(kept.lights[light].across, 1e9), bvec4(kept.lights[light].atInfinity != 0));
}

// With kClips: after how many layers the way from a position leaves the part of the volume that is drawn; 0 or less where the position is
// not in there.
float layersToClip(vec3 position, vec3 layer) {
  float layers = 1e9;
  [[unroll]] for (int axis = 0; axis < 3; ++axis)
    if (abs(layer[axis]) > 1e-6) {
      const float side = layer[axis] > 0.0 ? kept.clipHigh[axis] : kept.clipLow[axis];
      layers = min(layers, (side - position[axis]) / layer[axis]);
    }
  const float change = dot(kept.clipNormal, layer);
  if (change > 1e-6) layers = min(layers, (kept.clipDistance - dot(kept.clipNormal, position)) / change);
  return layers;
}

const float kClipStep = float(1 << kBrickLevels);  // blocks
const int kMaxClipSteps = 4096;  // no way through the volumes of one device is longer

// Whether the brick of the quad that is looked up at a place, in blocks, has blocks.
bool isInBrick(LevelGeometry level, vec3 place) {
  const ivec3 block = ivec3(floor(vec3(place[kSideA], place[kSideB], place[kAxis] + 0.5)));
  return brickAt(level, clamp(block, ivec3(0), ivec3(level.dimensions, level.count) - 1)) != 0;
}

// With kClips: takes from the depths towards the lights at a position what is clipped, which is the depth where the way to the light leaves
// the part that is drawn. Bricks without blocks have no depths; as nothing is in the way in them, the depth is that where the way back to
// the position enters the first brick. `stored` is the number of blocks towards the light of which a block's depth is.
void passClipped(inout vec4 depths, LevelGeometry level, vec3 position, float edge, float stored) {
  [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i) {
    if (i >= kLights) continue;
    const vec4 way = layerTowards(i, position);
    const float layers = layersToClip(position, way.xyz);
    const float blocks = layers / edge - stored;
    vec3 place = (position + 0.5) / edge - 0.5 + blocks * way.xyz;
    vec3 end;
    end[kAxis] = float(level.count) - 0.5;
    end[kSideA] = float(level.dimensions.x) - 0.5;
    end[kSideB] = float(level.dimensions.y) - 0.5;
    const bool clips = layers < way.w && (layers <= 0.0 || (all(greaterThan(place, vec3(-0.5))) && all(lessThan(place, end))));
    int steps = clips ? clamp(int(ceil(blocks / kClipStep)), 0, kMaxClipSteps) : 0;
    float step = 0.0;  // of the last move
    do {
      if (steps > 0) {
        if (isInBrick(level, place)) {
          steps = 0;
        } else {
          step = kClipStep;
          place -= kClipStep * way.xyz;
          --steps;
        }
      }
    } while (steps > 0);
    // To where the brick begins, between this place and the one before.
    [[unroll]] for (int bisection = 0; bisection < kBrickLevels; ++bisection) {
      step *= 0.5;
      const vec3 nearer = place + step * way.xyz;
      if (isInBrick(level, nearer)) place = nearer;
    }
    vec4 weights;
    const int quad = quadAt(level, vec2(place[kSideA], place[kSideB]), clamp(int(floor(place[kAxis] + 0.5)), 0, level.count - 1), weights);
    // All that is between the position and the light is clipped, or what is left of the way was empty.
    const bool isBeyond = layers <= 0.0 || quad >> (3 * kBrickLevels) == 0;
    if (clips) depths[i] = isBeyond ? 0.0 : max(depths[i] - lightDepth(i, quad, weights), 0.0);
  }
}

// Beyond the volume extinction falls to 0 within a block. So does the depth towards a light on that side, as the weights do; behind the
// volume it stays as it is at the border.
void continueDepths(inout vec4 depths, LevelGeometry level, vec2 position) {
  const vec2 first = clamp(position + 1.0, 1e-6, 1.0), last = clamp(vec2(level.dimensions) - position, 1e-6, 1.0);
  [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i) {
    if (i >= kLights) continue;
    const SampleLight light = kept.lights[i];
    const vec2 shares = max(first, vec2(light.lightsFirst[kSideA], light.lightsFirst[kSideB])) *
                        max(last, vec2(light.lightsLast[kSideA], light.lightsLast[kSideB]));
    const float share = shares.x * shares.y;
    depths[i] /= share * share;
  }
}

// The depths towards the lights on a slice beyond the volume, from those at the other end of the stretch to it.
vec4 depthsBeyond(int slice, vec4 depths) {
  [[unroll]] for (int i = 0; i < kMaxSampleLights; ++i)
    if (i < kLights) depths[i] *= 1.0 - (slice < 0 ? kept.lights[i].lightsFirst[kAxis] : kept.lights[i].lightsLast[kAxis]);
  return depths;
}

#endif
