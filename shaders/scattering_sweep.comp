#version 460
// The radiance at the centres of all cells in all directions, times the directions' weights: the sweeps of Subr et al. 2007, Section
// 3.1, with the light that cells send out as their source. A thread marches through all planes across the last axis of the step. Where it
// leaves the volume at a side, it continues at the opposite side with the line that enters there, so that all lines are marched and every
// cell is visited once.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 1) const bool kFlux = false;
layout(constant_id = 2) const bool kTinted = false;  // whether each channel has its own extinction

layout(local_size_x = kScatteringThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringSweepPush push; };
layout(binding = 0) uniform textureBuffer medium;   // whose first planes are extinctions
layout(binding = 1) uniform textureBuffer sources;  // by moment and cell
layout(binding = 2, scalar) readonly restrict buffer Directions { SweepDirection directions[]; };
layout(binding = 3, scalar) writeonly restrict buffer Light { float light[]; };  // by direction of the batch, channel and cell

void main() {
  const int number = int(gl_LocalInvocationID.x + kScatteringThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const SweepDirection direction = directions[push.firstDirection + int(gl_WorkGroupID.z)];
  const ivec3 axes = direction.step.z != 0 ? ivec3(0, 1, 2) : direction.step.y != 0 ? ivec3(0, 2, 1) : ivec3(1, 2, 0);
  const ivec2 sides = ivec2(push.cells[axes.x], push.cells[axes.y]);
  if (number >= sides.x * sides.y) return;
  const ivec3 strides = ivec3(1, push.cells.x, push.cells.x * push.cells.y);
  const int planes = push.cells[axes.z], count = strides.z * push.cells.z;
  const ivec3 step = ivec3(direction.step[axes.x], direction.step[axes.y], direction.step[axes.z]);
  const int slot = int(gl_WorkGroupID.z) * kChannels * count;
  const vec3 sky = push.hasSky != 0 ? direction.sky : vec3(0.0), flux = push.flux * direction.unit;
  ivec2 side = ivec2(number % sides.x, number / sides.x);
  int plane = step.z > 0 ? 0 : planes - 1;
  vec3 radiance = sky, sourceBefore = vec3(0.0), extinctionBefore = vec3(0.0);
  for (int k = 0; k < planes; ++k) {
    const int place = side.x * strides[axes.x] + side.y * strides[axes.y] + plane * strides[axes.z];
    vec3 through, mean, source = texelFetch(sources, place).rgb;
    if (kFlux)
      [[unroll]] for (int i = 0; i < 3; ++i) source += flux[i] * texelFetch(sources, (1 + i) * count + place).rgb;
    [[unroll]] for (int c = 0; c < kChannels; ++c) {
      if (c == 0 || kTinted) {
        const float extinction = texelFetch(medium, c * count + place).x, depth = 0.5 * direction.stepLength * (extinctionBefore[c] + extinction);
        through[c] = exp(-depth);
        mean[c] = depth < 0.02 ? 1.0 - depth * (0.5 - depth / 6.0) : (1.0 - through[c]) / depth;
        extinctionBefore[c] = extinction;
      } else {
        through[c] = through[0];
        mean[c] = mean[0];
      }
      radiance[c] = radiance[c] * through[c] + 0.5 * direction.stepLength * mean[c] * (sourceBefore[c] + source[c]);
    }
    sourceBefore = source;
    [[unroll]] for (int c = 0; c < kChannels; ++c) light[slot + c * count + place] = direction.weight * radiance[c];
    plane += step.z;
    side += step.xy;
    const bvec2 below = lessThan(side, ivec2(0)), above = greaterThanEqual(side, sides);
    if (any(below) || any(above)) {
      radiance = sky;
      sourceBefore = extinctionBefore = vec3(0.0);
    }
    side = mix(mix(side, sides - 1, below), ivec2(0), above);
  }
}
