#version 460
// The mean radiance that reaches the medium of each cell directly from one light: the mean over its direct cells, weighted by their
// extinction. Rays towards the light step through the planes of direct cells across their major axis, and interpolate bilinearly on them.
#extension GL_GOOGLE_include_directive : require
#include "scattering_interface.h"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 1) const bool kFlux = false;

layout(local_size_x = kDirectThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringDirectPush push; };
layout(binding = 0, scalar) readonly restrict buffer Extinctions { float extinctions[]; };  // of direct cells
layout(binding = 1, scalar) restrict buffer Direct { float direct[]; };                      // a vector

float extinctionAt(ivec3 cell) {
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, push.directCells))) return 0.0;
  return extinctions[cell.x + push.directCells.x * (cell.y + push.directCells.y * cell.z)];
}

// On the plane of cells through `position` across `axis`.
float extinctionOnPlane(vec3 position, int axis) {
  const vec3 low = floor(position + (axis == 0 ? vec3(0.5, 0.0, 0.0) : axis == 1 ? vec3(0.0, 0.5, 0.0) : vec3(0.0, 0.0, 0.5)));
  const ivec3 cell = ivec3(low);
  const vec3 part = position - low;
  const ivec3 a = axis == 0 ? ivec3(0, 1, 0) : ivec3(1, 0, 0), b = axis == 2 ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
  const float alongA = dot(part, vec3(a)), alongB = dot(part, vec3(b));
  return mix(mix(extinctionAt(cell), extinctionAt(cell + a), alongA), mix(extinctionAt(cell + b), extinctionAt(cell + a + b), alongA), alongB);
}

// The number of steps after which a ray of one plane a step has left the volume.
int stepsInside(vec3 position, vec3 step, int axis) {
  const float along = position[axis], end = step[axis] > 0.0 ? float(push.directCells[axis] - 1) - along : along;
  float steps = end;
  for (int side = 0; side < 3; ++side) {
    if (abs(step[side]) < 1e-6) continue;
    const float border = step[side] > 0.0 ? float(push.directCells[side]) - position[side] : position[side] + 1.0;
    steps = min(steps, border / abs(step[side]));
  }
  return max(int(floor(steps)), 0);
}

void main() {
  const int number = int(gl_LocalInvocationID.x + kDirectThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const int count = push.cells.x * push.cells.y * push.cells.z;
  if (number >= count) return;
  const ivec3 first = push.ratio * ivec3(number % push.cells.x, number / push.cells.x % push.cells.y, number / (push.cells.x * push.cells.y));
  vec3 sums[4] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  float weight = 0.0;
  for (int part = 0; part < push.ratio * push.ratio * push.ratio; ++part) {
    const ivec3 cell = first + ivec3(part % push.ratio, part / push.ratio % push.ratio, part / (push.ratio * push.ratio));
    const float own = extinctionAt(cell);
    if (own <= 0.0) continue;
    const vec3 position = vec3(cell);
    vec3 toLight = push.atInfinity != 0 ? push.place : push.place - position;
    const vec3 size = abs(toLight);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float planes = push.atInfinity != 0 ? 1e9 : size[axis];  // to the light
    const vec3 step = toLight / max(size[axis], 1e-6);
    const float length1 = length(push.directToWorld * step);
    float inFront = 0.0;
    const int steps = min(stepsInside(position, step, axis), int(ceil(planes)));
    int k = 1;
    bool more;
    do {
      if (k <= steps) inFront += clamp(planes - float(k) + 0.5, 0.0, 1.0) * extinctionOnPlane(position + float(k) * step, axis);
      more = ++k <= steps;
    } while (more);
    const float depth = own * min(0.5, planes) + inFront;
    const vec3 way = push.directToWorld * toLight;
    const float edge2 = pow(abs(determinant(push.directToWorld)), 2.0 / 3.0);
    const float distance2 = push.atInfinity != 0 ? 1.0 : max(dot(way, way), kNearestLight2 * edge2);
    const vec3 reaching = own / distance2 * push.radiance * exp(-length1 * depth * push.depthScale);
    const vec3 unit = way * inversesqrt(max(dot(way, way), 1e-30));
    sums[0] += reaching;
    if (kFlux) [[unroll]] for (int i = 0; i < 3; ++i) sums[1 + i] -= unit[i] * reaching;
    weight += own;
  }
  const float scale = weight > 0.0 ? 1.0 / weight : 0.0;
  [[unroll]] for (int moment = 0; moment < 4; ++moment) {
    if (moment > 0 && !kFlux) continue;
    [[unroll]] for (int c = 0; c < kChannels; ++c) {
      const int place = (moment * kChannels + c) * count + number;
      direct[place] = scale * sums[moment][c] + (push.isFirst != 0 ? 0.0 : direct[place]);
    }
  }
}
