// Part of gather.comp, whose frame and constants it reads: the light that a part of a ray scatters to the
// eye.
#ifndef GATHER_LIGHT_GLSL
#define GATHER_LIGHT_GLSL
#include "surface_scattering.glsl"

// The mean of exp(-depth) over a part along which the depth changes from 0 to x, of either sign.
float meanTransmittance(float x) { return abs(x) < 0.02 ? 1.0 - x * (0.5 - x / 6.0) : (1.0 - exp(-x)) / x; }

// The lighting of a part of a ray: optical depths towards the lights at its beginning, and their change along
// it.
struct Lit {
  vec4 begin, change;
  vec3 ambientBegin, ambientChange;  // those that ambient light has passed, by channel
  vec3 position;        // of its middle, in index space
  vec3 normal;          // outward unit normal of a surface there, in world space
  float surface;        // fraction that is reflected like a surface
  vec4 outside;         // optical depths towards the lights from outside of the surface
};

// The addition of a surface to the sum of lightOf(). A surface that faces the light is not shadowed by its
// own voxels, which would take half of the light on average.
vec3 surfaceLight(Lit lit, int light, vec3 way, float depth, vec3 toEye) {
  const bool facing = dot(lit.normal, way) > 0.0;
  const float begin = facing ? lit.outside[light] : lit.begin[light], change = facing ? 0.0 : lit.change[light];
  const vec3 tint = kTinted ? frame.tint : vec3(1.0);
  vec3 through;
  [[unroll]] for (int c = 0; c < 3; ++c) through[c] = exp(-tint[c] * begin) * meanTransmittance(depth + tint[c] * change);
  return lit.surface * (facing ? 0.5 : 1.0) * surfaceScattering(lit.normal, way, toEye) * through;
}

// The mean over the part of the light that is scattered to the eye for albedo 1, times the transmittance of
// what is in front within the part, whose optical depth is `depth`.
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
  // At the end of its code a depth may be larger, and a tint would let light through.
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
