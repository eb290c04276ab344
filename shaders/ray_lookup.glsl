// Optical depth between the source of a ray sweep and a position on one of its planes.
#ifndef RAY_LOOKUP_GLSL
#define RAY_LOOKUP_GLSL
#include "catmull_rom.glsl"
#include "interface.h"
#include "major_axis.glsl"
#include "ray_pair.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RayDepths { uint pairs[]; };

// The codes of a ray on a pair of planes. On lavapipe, texels are much faster than addresses: a shader that binds the depths of the source's
// rays as texels defines RAY_DEPTHS_BINDING, and has their address in push.rays.
#ifdef RAY_DEPTHS_BINDING
layout(constant_id = 1) const bool kRayTexels = true;  // whether all depths of the source are within the range of texels
layout(binding = RAY_DEPTHS_BINDING) uniform utextureBuffer rayDepths;
uint rayCodes(uvec2 pair, uint ray) {
  return kRayTexels ? texelFetch(rayDepths, int((pair.x - push.rays.x) / 4 + ray)).x : RayDepths(pair).pairs[ray];
}
#else
uint rayCodes(uvec2 pair, uint ray) { return RayDepths(pair).pairs[ray]; }
#endif

// `fromSource` is the direction from the source to the position.
int fanIndex(vec3 fromSource) {
  const int axis = majorAxis(fromSource);
  return 2 * axis + (fromSource[axis] > 0.0 ? 1 : 0);
}


// Where a position lies between the rays of a plane.
struct RayPlace {
  uint first;   // the first of 4x4 rays around it
  int odd;      // which plane of the pair
  vec2 within;  // position between the middle 2x2 rays, 0..1
  float apart;  // voxels between rays
};

RayPlace rayPlace(FaceRays fan, vec3 position, int plane) {
  RayPlace place;
  const float up = float(fan.firstPlane + fan.direction * plane) - fan.farthest;
  const vec2 side = vec2(position[(fan.axis + 1) % 3], position[(fan.axis + 2) % 3]);
  place.apart = fan.spacing * (1.0 + fan.convergence * up);
  const vec2 ray = (side - fan.origin - fan.slope * up) / place.apart;
  const vec2 low = clamp(floor(ray), vec2(1.0), vec2(fan.rayCount - 3));
  place.within = clamp(ray - low, 0.0, 1.0);
  const uint row = uint(fan.rayCount.x);
  place.first = uint(low.x) - 1 + (uint(low.y) - 1) * row;
  place.odd = plane & 1;
  return place;
}

float rayDepth(FaceRays fan, vec3 position) {
  if (fan.planeCount == 0) return 0.0;  // only for a voxel at the source
  // At the source, the first axis.
  const int plane = clamp((int(round(position[fan.axis])) - fan.firstPlane) * fan.direction, 0, fan.planeCount - 1);
  const RayPlace at = rayPlace(fan, position, plane);
  const vec2 w = at.within;
  const uint row = uint(fan.rayCount.x);
  uint first = at.first;
  const uvec2 pair = pairAddress(fan, plane / 2);
  const vec4 weightsX = cubicWeights(w.x), weightsY = cubicWeights(w.y);
  float sum = 0.0;
  [[unroll]] for (int j = 0; j < 4; ++j) {
    vec4 line;
    [[unroll]] for (int i = 0; i < 4; ++i) line[i] = unpackUnorm2x16(rayCodes(pair, first + i))[at.odd];
    line *= line * kOpaqueDepth;
    sum += dot(line, weightsX) * weightsY[j];
    first += row;
  }
  return max(sum, 0.0);
}

// On the side from which rays come, there is nothing in front of the first plane.
float depthUpTo(FaceRays fan, vec3 position) {
  const int plane = (int(round(position[fan.axis])) - fan.firstPlane) * fan.direction;
  return plane < 0 ? 0.0 : rayDepth(fan, position);
}

#endif
