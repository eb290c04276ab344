#version 460
// Optical depth from an eye or a light inside the volume to the outside, in the table's directions and in
// layers of voxels: A_V of Subr et al. 2007, Section 3.3. A thread for each direction marches from the eye
// like the sweeps from a voxel, and adds half of the extinction at the eye itself.
#extension GL_GOOGLE_include_directive : require
#include "frame_interface.h"

layout(local_size_x = kEyeThreads) in;
layout(scalar, push_constant) uniform Push { EyeDepthsPush push; };
layout(scalar, binding = 1) writeonly buffer EyeDepths { float eyeDepths[]; };
#define OCCUPANCY_BINDING 0
#define STORES push.stores
#include "stored_block.glsl"

float extinctionAt(vec3 place) {
  const vec3 low = floor(place);
  const vec3 w = place - low;
  float sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 side = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const vec3 share = mix(1.0 - w, w, vec3(side));
    sum += share.x * share.y * share.z * extinctionOf(push.voxels, ivec3(low) + side);
  }
  return sum;
}

void main() {
  const int edge = 2 * push.cells + 1;
  const int i = int(gl_GlobalInvocationID.x);
  if (i >= edge * edge * edge) return;
  const vec3 cell = vec3(i % edge, i / edge % edge, i / edge / edge) - float(push.cells);
  const vec3 size = abs(cell);
  if (max(size.x, max(size.y, size.z)) < push.cells) return;  // a cell inside the cube, which is not a direction
  const vec3 layer = cell / push.cells;
  float sum = 0.5 * extinctionAt(push.place);
  vec3 place = push.place + layer;
  while (all(greaterThan(place, vec3(-1.0))) && all(lessThan(place, vec3(push.voxels.dimensions)))) {
    sum += extinctionAt(place);
    place += layer;
  }
  eyeDepths[push.first + i] = sum;
}
