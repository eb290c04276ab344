// Part of gather.comp, whose frame and constants it reads: what a light sends to the eye from a part of a ray.
#ifndef GATHER_LIGHT_GLSL
#define GATHER_LIGHT_GLSL
#include "surface_scattering.glsl"

// The mean of exp(-depth) over a part along which the depth grows from 0 to x, of either sign.
float meanTransmittance(float x) { return abs(x) < 0.02 ? 1.0 - x * (0.5 - x / 6.0) : (1.0 - exp(-x)) / x; }

// What a part of the ray is lit by: optical depths towards the lights at its beginning, and how they change along it.
struct Lit {
  vec4 begin, change;
  vec3 ambientBegin, ambientChange;  // the same of what ambient light has passed, by channel
  vec3 position;        // of its middle, index space
  vec3 normal;          // of a surface there, outwards, in the world, of length 1
  float surface;        // how much of one it is
  vec4 outside;         // optical depths towards the lights from outside of it
};

// What a surface adds to the sum of lightOf(). Where it faces the light its own voxels do not shadow it, which on average takes half.
vec3 surfaceLight(Lit lit, int light, vec3 way, float depth, vec3 toEye) {
  const bool facing = dot(lit.normal, way) > 0.0;
  const float begin = facing ? lit.outside[light] : lit.begin[light], change = facing ? 0.0 : lit.change[light];
  const vec3 tint = kTinted ? frame.tint : vec3(1.0);
  vec3 through;
  [[unroll]] for (int c = 0; c < 3; ++c) through[c] = exp(-tint[c] * begin) * meanTransmittance(depth + tint[c] * change);
  return lit.surface * (facing ? 0.5 : 1.0) * surfaceScattering(lit.normal, way, toEye) * through;
}

// The mean over the part of what a light sends to the eye per albedo, times the transmittance of what is in front of it in the
// part, whose optical depth is `depth`.
vec3 lightOf(int light, Lit lit, float depth, vec3 toEye) {
  const SampleLight source = frame.lights[light];
  vec3 way = source.place;
  float distance2 = 1.0;
  if (source.atInfinity == 0) {
    way = frame.indexToWorld * (source.place - lit.position);
    distance2 = max(dot(way, way), frame.nearestLight2);
    way *= inversesqrt(max(dot(way, way), 1e-30));
  }
  const float begin = lit.begin[light], change = lit.change[light];
  // At the end of its code a depth may be any larger one, and a tint would let light through.
  if (kTinted && begin + max(change, 0.0) >= kMostLightDepth) return vec3(0.0);
  vec3 sum = vec3(0.0);
  float scale = 1.0;
  for (int octave = 0; octave < kOctaves; ++octave) {
    float phase = frame.phaseG == 0.0 ? 1.0 / (4.0 * kPi) : phaseFunction(scale * frame.phaseG, -way, toEye);
    if (kSurfaces) phase *= 1.0 - lit.surface;
    vec3 through;
    if (kTinted)
      [[unroll]] for (int c = 0; c < 3; ++c)
        through[c] = exp(-scale * frame.tint[c] * begin) * meanTransmittance(depth + scale * frame.tint[c] * change);
    else
      through = vec3(exp(-scale * begin) * meanTransmittance(depth + scale * change));
    sum += scale * phase * through;
    scale *= frame.octaveScale;
  }
  if (kSurfaces && lit.surface > 0.0) sum += surfaceLight(lit, light, way, depth, toEye);
  return source.color / distance2 * sum;
}

#endif
