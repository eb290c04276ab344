// Optical depth between the source of a ray sweep and a position on one of its planes, and its derivatives
// within the plane.
#ifndef RAY_LOOKUP_GLSL
#define RAY_LOOKUP_GLSL
#include "catmull_rom.glsl"
#include "interface.h"
#include "major_axis.glsl"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RayDepths { uint pairs[]; };

// `fromSource` is the direction from the source to the position.
int fanIndex(vec3 fromSource) {
  const int axis = majorAxis(fromSource);
  return 2 * axis + (fromSource[axis] > 0.0 ? 1 : 0);
}

// The depth, and its change per voxel along the two sides of the face.
vec3 rayDepth(FaceRays fan, vec3 position) {
  if (fan.planeCount == 0) return vec3(0.0);  // only for a voxel at the source
  // At the source, the first axis.
  const int plane = clamp((int(round(position[fan.axis])) - fan.firstPlane) * fan.direction, 0, fan.planeCount - 1);
  const float up = float(fan.firstPlane + fan.direction * plane) - fan.farthest;
  const vec2 side = vec2(position[(fan.axis + 1) % 3], position[(fan.axis + 2) % 3]);
  const float apart = fan.spacing * (1.0 + fan.convergence * up);
  const vec2 place = (side - fan.origin - fan.slope * up) / apart;
  const vec2 low = clamp(floor(place), vec2(1.0), vec2(fan.rayCount - 3));
  const vec2 w = clamp(place - low, 0.0, 1.0);
  const uint row = uint(fan.rayCount.x);
  uint first = uint(plane / 2) * row * uint(fan.rayCount.y) + uint(low.x) - 1 + (uint(low.y) - 1) * row;
  RayDepths depths = RayDepths(fan.depths);
  const vec4 weightsX = cubicWeights(w.x), slopesX = cubicSlopes(w.x);
  const vec4 weightsY = cubicWeights(w.y), slopesY = cubicSlopes(w.y);
  vec3 sum = vec3(0.0);
  [[unroll]] for (int j = 0; j < 4; ++j) {
    vec4 line;
    [[unroll]] for (int i = 0; i < 4; ++i) line[i] = unpackUnorm2x16(depths.pairs[first + i])[plane & 1];
    line *= line * kOpaqueDepth;
    const float value = dot(line, weightsX);
    sum += vec3(value * weightsY[j], vec2(dot(line, slopesX) * weightsY[j], value * slopesY[j]) / apart);
    first += row;
  }
  return vec3(max(sum.x, 0.0), sum.yz);
}

#endif
