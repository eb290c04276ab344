#version 460
// The mean radiance that reaches the medium of each cell directly from one light: the mean over its direct cells, weighted by their
// extinction. Depths towards the light are those of its swept rays through the direct cells (ray_sweep.comp).
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_samplerless_texture_functions : require
#include "scattering_interface.h"

layout(constant_id = 0) const int kChannels = 1;
layout(constant_id = 2) const bool kFlux = false;
layout(constant_id = 3) const bool kAtInfinity = false;

layout(local_size_x = kDirectThreads) in;
layout(scalar, push_constant) uniform Push { ScatteringDirectPush push; };
layout(binding = 0) uniform textureBuffer extinctions;  // of direct cells, with a border of one
layout(binding = 1, scalar) restrict buffer Direct { float direct[]; };  // a vector
layout(binding = 2, scalar) readonly restrict buffer Fans { DirectFans light; };
#define RAY_DEPTHS_BINDING 3
#include "ray_lookup.glsl"

float extinctionAt(ivec3 cell) {
  if (any(greaterThanEqual(cell, push.directCells))) return 0.0;
  const ivec3 size = push.directCells + 2;
  return texelFetch(extinctions, cell.x + 1 + size.x * (cell.y + 1 + size.y * (cell.z + 1))).x;
}

void main() {
  const int number = int(gl_LocalInvocationID.x + kDirectThreads * (gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x));
  const int count = push.cells.x * push.cells.y * push.cells.z;
  if (number >= count) return;
  const ivec3 first = push.ratio * ivec3(number % push.cells.x, number / push.cells.x % push.cells.y, number / (push.cells.x * push.cells.y));
  vec3 sums[4] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  float weight = 0.0;
  // Parallel rays have the same face in all six places; read once, as lavapipe reads buffers lane by lane.
  const FaceRays parallel = light.fans[0];
  for (int part = 0; part < push.ratio * push.ratio * push.ratio; ++part) {
    const ivec3 cell = first + ivec3(part % push.ratio, part / push.ratio % push.ratio, part / (push.ratio * push.ratio));
    const float own = extinctionAt(cell);
    if (own <= 0.0) continue;
    const vec3 position = vec3(cell);
    const vec3 toLight = kAtInfinity ? push.place : push.place - position;
    const vec3 size = abs(toLight);
    const float most = max(size.x, max(size.y, size.z));
    const float layers = kAtInfinity ? 0.5 : min(most, 0.5);  // of the cell itself, up to the light
    const float layer = length(push.directToWorld * (toLight / max(most, 1e-6)));
    FaceRays fan = parallel;
    if (!kAtInfinity) fan = light.fans[fanIndex(-toLight)];
    const float depth = depthUpTo(fan, position) + layers * layer * own;
    const vec3 way = push.directToWorld * toLight;
    const float edge2 = pow(abs(determinant(push.directToWorld)), 2.0 / 3.0);
    const float distance2 = kAtInfinity ? 1.0 : max(dot(way, way), kNearestLight2 * edge2);
    const vec3 reaching = own / distance2 * push.radiance * exp(-depth * push.depthScale);
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
