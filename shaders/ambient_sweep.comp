#version 460
// Adds to every cell of a volume what reaches it of the light from a direction: Subr et al. 2007, Section 3.1. A thread marches
// through all planes across an axis; where it leaves the volume at a side it goes on at the other one, on the line that enters
// there, so that all lines are marched and every cell is met once.
#extension GL_GOOGLE_include_directive : require
#include "gather_interface.h"

layout(constant_id = 0) const int kChannels = 1;

layout(local_size_x = kAmbientThreads) in;
layout(scalar, push_constant) uniform Push { AmbientSweepPush push; };
layout(scalar, binding = 0) readonly buffer Extinctions { float extinctions[]; };
layout(scalar, binding = 1) buffer CellLight { float light[]; };

void main() {
  const int number = int(gl_LocalInvocationID.x + kAmbientThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const ivec3 axes = push.axes;
  const ivec2 sides = ivec2(push.cells[axes.x], push.cells[axes.y]);
  if (number >= sides.x * sides.y) return;
  const ivec3 strides = ivec3(1, push.cells.x, push.cells.x * push.cells.y);
  const int count = push.cells[axes.z], ofChannel = strides.z * push.cells.z;
  const ivec3 step = ivec3(push.step[axes.x], push.step[axes.y], push.step[axes.z]);
  ivec2 side = ivec2(number % sides.x, number / sides.x);
  int plane = step.z > 0 ? 0 : count - 1;
  float depth = 0.0;  // in front of the cell
  for (int k = 0; k < count; ++k) {
    const int place = side.x * strides[axes.x] + side.y * strides[axes.y] + plane * strides[axes.z];
    const float own = extinctions[place] * push.stepLength, middle = depth + 0.5 * own;
    [[unroll]] for (int c = 0; c < kChannels; ++c) {
      float scale = 1.0, sum = 0.0;
      for (int octave = 0; octave < push.octaves; ++octave) {
        sum += scale * exp(-scale * push.tint[c] * middle);
        scale *= push.octaveScale;
      }
      light[place + c * ofChannel] += push.share[c] * sum;
    }
    depth += own;
    plane += step.z;
    side += step.xy;
    const bvec2 below = lessThan(side, ivec2(0)), above = greaterThanEqual(side, sides);
    if (any(below) || any(above)) depth = 0.0;
    side = mix(mix(side, sides - 1, below), ivec2(0), above);
  }
}
