#version 460
// Adds to every cell of a volume the light that reaches it from one direction: Subr et al. 2007, Section 3.1.
// A thread marches through all planes across the last axis of the step. Where it leaves the volume at a side,
// it continues at the opposite side with the line that enters there, so that all lines are marched and every
// cell is visited once.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gather_interface.h"
#include "phase_function.glsl"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 1) const bool kPhase = false;  // whether the light is weighted by the phase function towards the eye

layout(local_size_x = kAmbientThreads) in;
layout(scalar, push_constant) uniform Push { AmbientSweepPush push; };
layout(binding = 0) uniform textureBuffer extinctions;
// The channels one after the other; with kPhase followed by the sum of weights.
layout(binding = 1, r32f) uniform imageBuffer light;

// The weight of an octave of scattering, relative to isotropic scattering.
float phaseAt(ivec3 cell, float g) {
  const vec3 toEye = push.orthographic != 0 ? push.eye : push.eye - vec3(cell);
  const vec3 towards = push.cellToWorld * toEye;
  const float length2 = dot(towards, towards);
  if (length2 == 0.0) return 1.0;
  return 4.0 * kPi * phaseFunction(g, normalize(push.cellToWorld * vec3(push.step)), towards * inversesqrt(length2));
}

void add(int place, float part) { imageStore(light, place, imageLoad(light, place) + part); }

void main() {
  const int number = int(gl_LocalInvocationID.x + kAmbientThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const ivec3 axes = push.step.z != 0 ? ivec3(0, 1, 2) : push.step.y != 0 ? ivec3(0, 2, 1) : ivec3(1, 2, 0);
  const ivec2 sides = ivec2(push.cells[axes.x], push.cells[axes.y]);
  if (number >= sides.x * sides.y) return;
  const ivec3 strides = ivec3(1, push.cells.x, push.cells.x * push.cells.y);
  const int count = push.cells[axes.z], ofChannel = strides.z * push.cells.z;
  const ivec3 step = ivec3(push.step[axes.x], push.step[axes.y], push.step[axes.z]);
  ivec2 side = ivec2(number % sides.x, number / sides.x);
  int plane = step.z > 0 ? 0 : count - 1;
  float depth = 0.0;  // optical depth in front of the cell
  for (int k = 0; k < count; ++k) {
    const int place = side.x * strides[axes.x] + side.y * strides[axes.y] + plane * strides[axes.z];
    const float own = texelFetch(extinctions, place).x * push.stepLength, middle = depth + 0.5 * own;
    ivec3 cell;
    cell[axes.x] = side.x;
    cell[axes.y] = side.y;
    cell[axes.z] = plane;
    vec3 sums = vec3(0.0);
    float scale = 1.0, weights = 0.0;
    for (int octave = 0; octave < push.octaves; ++octave) {
      const float weight = kPhase ? scale * phaseAt(cell, scale * push.phaseG) : scale;
      [[unroll]] for (int c = 0; c < kChannels; ++c) sums[c] += weight * exp(-scale * push.tint[c] * middle);
      weights += weight;
      scale *= push.octaveScale;
    }
    [[unroll]] for (int c = 0; c < kChannels; ++c) add(place + c * ofChannel, push.share[c] * sums[c]);
    if (kPhase) add(place + kChannels * ofChannel, push.weight * weights);
    depth += own;
    plane += step.z;
    side += step.xy;
    const bvec2 below = lessThan(side, ivec2(0)), above = greaterThanEqual(side, sides);
    if (any(below) || any(above)) depth = 0.0;
    side = mix(mix(side, sides - 1, below), ivec2(0), above);
  }
}
